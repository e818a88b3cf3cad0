#version 460
#include "lib/prelude.glsl"
#include "groups/light_caches.glsl"
#include "caches/asking.glsl"
#include "lib/pixels.glsl"
#include "lib/spherical_harmonics.glsl"
#include "lib/surface_packing.glsl"
#include "caches/weights.glsl"

// The slot `diffuse` of one pixel: radiance in W/(m²·sr), L(x) = ρ/π · E(x), with ρ = indirect_diffuse_albedo() and the irradiance E at the shading normal n of the eight
// caches around x, weighed trilinearly (Reich 2015, section 4.4) and, if asked for, by whether x sees them (caches/weights.glsl),
//
//   E(x) = Σ_lm A_l y_lm(n) · Σ_k w_k c_lm,k / Σ_k w_k
//
// In zones of transition two cascades share, linearly. Caches that are not there are counted, and leave their weight to the others.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint BANDS = 3u;

layout(set = 0, binding = 0) uniform samplerBuffer light;  // volumes/light.comp
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D diffuse;
layout(set = 0, binding = 2) buffer MissingBlock { uint missing[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    uint capacity;
} push;

const int TEXELS = BANDS == 3u ? 7 : 3;

// Σ A_l c_lm y_lm(n) of the cache's three channels, by the weights.
vec3 irradiance_from(int cache, vec4 low, vec4 high, float last) {
    int first = TEXELS * cache;
    vec3 sum;
    if (BANDS == 3u) {
        for (int channel = 0; channel < 3; ++channel) {
            sum[channel] = dot(texelFetch(light, first + 2 * channel), low) + dot(texelFetch(light, first + 2 * channel + 1), high);
        }
        sum += last * texelFetch(light, first + 6).rgb;
    } else {
        for (int channel = 0; channel < 3; ++channel) {
            sum[channel] = dot(texelFetch(light, first + channel), low);
        }
    }
    return sum;
}

vec3 irradiance_at(Surface point) {
    vec4 low = cosine_of_low_bands(point.normal);
    vec4 high = cosine_of_band_2(point.normal);
    float last = last_cosine(point.normal);
    float next;
    int cascade = cascade_of(cascades, point.position_rs, next);
    vec3 irradiance = vec3(0.0);
    [[dont_unroll]] for (int step = 0; step < 2; ++step) {
        float share = step == 0 ? 1.0 - next : next;
        if (share > 0.0) {
            Place place = place_in(cascades, cascade + step, point.position_rs);
            vec3 sum = vec3(0.0);
            float weights = 0.0;
            [[dont_unroll]] for (int corner = 0; corner < 8; ++corner) {
                ivec3 offset = corner_of(corner);
                vec3 shares = mix(1.0 - place.along, place.along, vec3(offset));
                uint address = address_of(cascades, place.cascade, place.lowest + offset);
                uint cache = texelFetch(cache_addresses, int(address)).x - 1u;
                if (cache < push.capacity) {
                    float weight = shares.x * shares.y * shares.z;
                    weight *= weight_of_cache(push.rays, point, position_of_cache(cache), weight);
                    sum += weight * irradiance_from(int(cache), low, high, last);
                    weights += weight;
                } else {
                    atomicAdd(missing[0], 1u);
                }
            }
            irradiance += share / max(weights, 1e-6) * sum;
        }
    }
    return max(irradiance, vec3(0.0));
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    if (pixel_depth > 0.0) {
        vec3 position_rs = asking_position(ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 response = indirect_diffuse_albedo(point) * INVERSE_PI;
        if (max3(response) > 0.0) {
            radiance = response * irradiance_at(point);
        }
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
