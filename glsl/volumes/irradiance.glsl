// The irradiance of a point from the eight caches around it, weighed trilinearly (Reich 2015, section 4.4) and, if asked for, by whether the point sees them
// (caches/weights.glsl), W/m²,
//
//   E = Σ_lm A_l y_lm(n) · Σ_k w_k c_lm,k / Σ_k w_k
//
// In zones of transition two cascades share, linearly. Caches that are not there leave their weight to the others. The including file has the caches' light as
// `uniform samplerBuffer light` (volumes/light.glsl).
#ifndef VOLUMES_IRRADIANCE
#define VOLUMES_IRRADIANCE

#include "groups/light_caches.glsl"
#include "lib/color.glsl"
#include "lib/spherical_harmonics.glsl"
#include "caches/rays.glsl"
#include "caches/weights.glsl"
#include "volumes/numbers.glsl"

// `grey` of the luminance, in the colour of band 0.
vec3 in_colour(vec3 band_0, float grey) {
    return band_0 * (grey / max(luminance(band_0), 1e-37));
}

// Σ A_l c_lm y_lm(n) of the cache's three channels, by the weights.
vec3 irradiance_from(int cache, vec4 low, vec4 high, float last) {
    int first = TEXELS * cache;
    vec3 sum;
    if (CHROMA == 1u) {
        vec4 band_0 = texelFetch(light, first);
        float grey = dot(texelFetch(light, first + 1).xyz, low.yzw);
        if (BANDS == 3u) {
            grey += dot(texelFetch(light, first + 2), high) + last * band_0.w;
        }
        sum = low.x * band_0.rgb + in_colour(band_0.rgb, grey);
    } else if (BANDS == 3u && CHROMA == 2u) {
        vec3 band_0;
        for (int channel = 0; channel < 3; ++channel) {
            vec4 own = texelFetch(light, first + channel);
            band_0[channel] = own.x;
            sum[channel] = dot(own, low);
        }
        sum += in_colour(band_0, dot(texelFetch(light, first + 3), high) + last * texelFetch(light, first + 4).x);
    } else if (BANDS == 3u) {
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

// At a point with this normal of shading; `origin`: where rays from it start, in their space. `missing` counts caches that are not there.
vec3 irradiance_at(vec3 position_rs, vec3 normal, CacheRays rays, vec3 origin, uint capacity, out uint missing) {
    vec4 low = cosine_of_low_bands(normal);
    vec4 high = cosine_of_band_2(normal);
    float last = last_cosine(normal);
    float next;
    int cascade = cascade_of(cascades, position_rs, next);
    missing = 0u;
    vec3 irradiance = vec3(0.0);
    [[dont_unroll]] for (int step = 0; step < 2; ++step) {
        float share = step == 0 ? 1.0 - next : next;
        if (share > 0.0) {
            Place place = place_in(cascades, cascade + step, position_rs);
            vec3 sum = vec3(0.0);
            float weights = 0.0;
            [[dont_unroll]] for (int corner = 0; corner < 8; ++corner) {
                ivec3 offset = corner_of(corner);
                vec3 shares = mix(1.0 - place.along, place.along, vec3(offset));
                uint address = address_of(cascades, place.cascade, place.lowest + offset);
                uint cache = texelFetch(cache_addresses, int(address)).x - 1u;
                if (cache < capacity) {
                    float weight = shares.x * shares.y * shares.z;
                    weight *= weight_of_cache(origin, position_of_cache(cache) + rays.shift, weight);
                    sum += weight * irradiance_from(int(cache), low, high, last);
                    weights += weight;
                } else {
                    ++missing;
                }
            }
            irradiance += share / max(weights, 1e-6) * sum;
        }
    }
    return max(irradiance, vec3(0.0));
}

#endif
