#version 460
#include "lib/prelude.glsl"
#include "groups/light_caches.glsl"
#include "caches/asking.glsl"
#include "caches/pixel_origin.glsl"
#include "caches/weights.glsl"
#include "lib/directional_albedo.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "radiance_maps/horizon.glsl"
#include "radiance_maps/lobes.glsl"

// The slot `specular` of one pixel: radiance in W/(m²·sr). With f·cos dω = F·D·G (v·h)/(n·v) dω_h, the light of L(ω) is
//
//   L(x) = (f0·A + f90·B) · Σ_k w_k Σ_l c_l E_l,k(h) / Σ_k w_k Σ_l c_l W_l(h)
//
// w_k the weights of the eight caches around x (Reich 2015, section 4.4; volumes/irradiance.glsl), c_l the lobe's share of level l per solid angle (radiance_maps/lobes.glsl), E and
// W bilinear between the map's texels (radiance_maps/map.glsl), h the half vector of the direction that x mirrors, as cache k sees the eye. Of W only
// what lies above the surface's horizon counts. There is no light from below in maps with a horizon; in others a texel across it gives the mean of all of its light and of its
// share above. A and B are the lobe's directional albedo for Fresnel terms of 1 and 0, and 0 and 1: a uniform L is reflected as the lobe itself does.
//
// Both sums are weighed by the masking 1/(1 + Λ(v) + Λ(ω)) at each texel's middle.
//
// Blinn-Phong, the thesis' lobe, with f0 for ρ_s (4.25): L(x) = ρ_s (γ + 8)/(8π) · 2π/(γ + 1) · (n·v) · E per solid angle, at the level of γ, trilinearly.

layout(local_size_x = 64) in;

// 1: each cache is looked up where it shows the direction that x mirrors; 0: all where x itself would be, the paper.
layout(constant_id = 7) const uint FOLLOWS_MIRROR = 1u;

layout(set = 0, binding = 0) readonly buffer SlotBlock { uint map_slots[]; };  // of caches: the map's number plus one
layout(set = 0, binding = 1) uniform samplerBuffer maps;
layout(set = 0, binding = 2) uniform samplerBuffer tables;      // of each texel the middle h and W; then A, B
layout(set = 0, binding = 3, rgba32f) writeonly uniform image2D reflected;

layout(set = 0, binding = 4) readonly buffer HorizonBlock { uint horizons[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    uint cache_capacity;
    uint map_capacity;
} push;

const float LEAST_SHARE = 1.0 / 256.0;

struct Look {
    LevelShares shares;
    float masking;  // Λ(v)
    vec3 to_eye;
    vec3 mirrored;
};

// How much of a texel lies above the horizon: of a cap of its solid angle around its middle, at that height. Exact for whole spheres, and where the cap just touches.
float share_above(float height, float solid_angle) {
    float cosine = 1.0 - solid_angle / (2.0 * PI);
    float slope = cosine > 0.0 ? inversesqrt(1.0 - cosine * cosine) : (1.0 + cosine) / (1.0 - cosine);
    return clamp(0.5 + 0.5 * height * slope, 0.0, 1.0);
}

// Of one texel: its light, and the solid angle that this comes from above the horizon, both as masking leaves them.
vec4 light_of_texel(Look look, vec3 normal, bool lit_above, int first, int texel) {
    vec3 light = texelFetch(maps, first + texel).rgb;
    if (LOBE == LOBE_BLINN_PHONG) {
        return vec4(light, 1.0);
    }
    vec4 known = texelFetch(tables, texel);
    float height = 2.0 * known.z * dot(normal, known.xyz) - normal.z;
    float above = share_above(height, known.w);
    float lit = lit_above ? 1.0 : above > 0.0 ? 0.5 + 0.5 * above : 0.0;
    return vec4(lit * light, above * known.w) / (1.0 + look.masking + smith_lambda(max(height, 1e-2), sqrt(look.shares.alpha2)));
}

// Light, and the solid angle that it comes from, of one map.
vec4 look_up(Look look, Surface point, uint cache, int first) {
    bool lit_above = has_horizon(uvec3(horizons[3u * cache], horizons[3u * cache + 1u], horizons[3u * cache + 2u]));
    Frame frame = frame_around(FOLLOWS_MIRROR != 0u ? direction_to_eye(camera, position_of_cache(cache)) : look.to_eye);
    vec3 normal = to_local(frame, point.normal);
    vec3 middle = FOLLOWS_MIRROR != 0u ? half_direction(frame, look.mirrored) : normal;
    vec2 square = square_of_direction(middle);
    vec4 sum = vec4(0.0);
    int levels = LOBE == LOBE_BLINN_PHONG ? MAP_LEVELS : WIDE_LEVEL + 1;
    [[dont_unroll]] for (int level = 0; level < levels; ++level) {
        float share = share_of_level(look.shares, level);
        if (share > LEAST_SHARE) {
            float side = float(side_of_level(level));
            vec4 taken = share * vec4(vec3(side * side), LOBE == LOBE_BLINN_PHONG ? 1.0 : side * side);
            Corners corners = corners_of(square, level);
            [[dont_unroll]] for (int corner = 0; corner < 4; ++corner) {
                sum += corners.weights[corner] * taken * light_of_texel(look, normal, lit_above, first, corners.texels[corner]);
            }
        }
    }
    float wide = LOBE == LOBE_BLINN_PHONG ? 0.0 : 1.0 - share_up_to(look.shares, WIDE_LEVEL);
    if (wide > LEAST_SHARE) {
        int wide_texels = first_of_level(WIDE_LEVEL);
        [[dont_unroll]] for (int texel = 0; texel < 16; ++texel) {
            sum += wide * light_of_texel(look, normal, lit_above, first, wide_texels + texel);
        }
    }
    return sum;
}

vec3 incoming_light(Look look, Surface point) {
    vec3 origin = WEIGHTS == WEIGHTS_RAYS ? origin_of_pixel(point, push.rays) : vec3(0.0);
    float next;
    int cascade = cascade_of(cascades, point.position_rs, next);
    vec4 light = vec4(0.0);
    [[dont_unroll]] for (int step = 0; step < 2; ++step) {
        float share = step == 0 ? 1.0 - next : next;
        if (share > 0.0) {
            Place place = place_in(cascades, cascade + step, point.position_rs);
            vec4 sum = vec4(0.0);
            float weights = 0.0;
            [[dont_unroll]] for (int corner = 0; corner < 8; ++corner) {
                ivec3 offset = corner_of(corner);
                vec3 shares = mix(1.0 - place.along, place.along, vec3(offset));
                uint cache = texelFetch(cache_addresses, int(address_of(cascades, place.cascade, place.lowest + offset))).x - 1u;
                uint map = cache < push.cache_capacity ? map_slots[cache] - 1u : NO_ADDRESS;
                float weight = shares.x * shares.y * shares.z;
                if (map < push.map_capacity && weight > 0.0) {
                    weight *= weight_of_cache(origin, position_of_cache(cache) + push.rays.shift, weight);
                    sum += weight * look_up(look, point, cache, int(map) * MAP_TEXELS);
                    weights += weight;
                }
            }
            light += share / max(weights, 1e-6) * sum;
        }
    }
    return light.w > 0.0 ? light.rgb / light.w : vec3(0.0);
}

vec3 reflected_light(Surface point) {
    vec3 to_eye = direction_to_eye(camera, point.position_rs);
    float cosine = max(dot(point.normal, to_eye), 1e-3);
    LevelShares shares = shares_of(point);
    float masking = smith_lambda(cosine, sqrt(shares.alpha2));
    Look look = Look(shares, masking, to_eye, 2.0 * cosine * point.normal - to_eye);
    vec3 light = incoming_light(look, point);
    if (LOBE == LOBE_BLINN_PHONG) {
        float exponent = look.shares.exponent;
        return point.f0 * (cosine * (exponent + 8.0) / (8.0 * PI * (exponent + 1.0))) * light;
    }
    vec2 albedo = directional_albedo(tables, MAP_TEXELS, cosine, point.roughness);
    return (point.f0 * albedo.x + point.f90 * albedo.y) * light;
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(reflected);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec4 lobe = pixel_depth > 0.0 && HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    if (max(max3(lobe.rgb), lobe.a) > 0.0) {
        vec3 position_rs = asking_position(ndc_of_pixel(pixel, size), pixel_depth);
        radiance = reflected_light(unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe));
    }
    imageStore(reflected, pixel, vec4(radiance, 1.0));
}
