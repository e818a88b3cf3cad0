// The light of one map. The including file has visibility_of_group() and groups of 64 invocations.
#ifndef RADIANCE_MAPS_WRITE
#define RADIANCE_MAPS_WRITE

#include "groups/light_caches.glsl"
#include "groups/surface.glsl"
#include "caches/rays.glsl"
#include "radiance_maps/map.glsl"
#include "radiance_maps/of_map.glsl"
#include "radiance_maps/target.glsl"

// One group of invocations a map: each virtual area light i adds what it sends to the cache,
//
//   E_i = V_g(i) · Φ_i/π · (n_i·−ω_i)⁺ / (d_i² + a_i)        W/m²
//
// to the texel of its half vector (Reich 2015, section 4.3.3), or by its footprint: as a square of its area, in parts of the width of a texel, each shared out among the four
// nearest texels. What is still wider goes to a coarser level, which radiance_maps/mips.comp spreads. Neighbouring lights leave no gaps, and one that a cache is close to
// covers what it covers. Sums are whole numbers (radiance_maps/of_map.glsl).
//
// Light from behind the horizon of the surfaces around the cache, where they have one, is left out (radiance_maps/horizon.glsl).
//
// `cached`: they grow in shared memory, and are written once. In the thesis each cache has one invocation, which holds its map in registers.

const uint FILL_FOOTPRINT = 2u;
// Parts that a light is written in, along an edge.
const int MOST_PARTS = 4;

layout(constant_id = 4) const uint CACHED = 0u;
layout(constant_id = 5) const uint FILL = FILL_FOOTPRINT;

layout(set = 0, binding = 0) uniform usamplerBuffer map_head;
layout(set = 0, binding = 1) uniform usamplerBuffer map_caches;
layout(set = 0, binding = 2) uniform samplerBuffer map_bounds;
layout(set = 0, binding = 3) coherent buffer SumBlock { uint sums[]; };

layout(set = 0, binding = 4) readonly buffer HorizonBlock { uint horizons[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    int first_group;
    int end_group;
    uint capacity;
} push;

const int HELD = CACHED != 0u ? 3 * MAP_TEXELS : 1;

shared uint held[HELD];

void add_to_texel(uint first, int texel, vec3 amount) {
    uvec3 units = uvec3(amount + 0.5);
    for (uint channel = 0u; channel < 3u; ++channel) {
        if (units[channel] > 0u) {
            if (CACHED != 0u) {
                atomicAdd(held[3u * uint(texel) + channel], units[channel]);
            } else {
                atomicAdd(sums[first + 3u * uint(texel) + channel], units[channel]);
            }
        }
    }
}

// The level whose texels are nearest in width to what comes from this solid angle: half vectors move half as far as directions in the plane of v and h, and 1/(v·h) times
// that across it.
int level_of_angle(float solid_angle, float view_cosine) {
    float ratio = solid_angle / (4.0 * view_cosine * view_cosine * texel_angle(0));
    return clamp(int(round(0.5 * log2(clamp(ratio, 1e-6, 1e12)))), 0, MAP_LEVELS - 1);
}

// One of n² parts of a light: E = Φ/(πn²) · cos/(d² + a/n²) · 2/(1 + x), x = d/√(d² + a/n²). The last factor makes E/L the solid angle of a disc on its axis, 2π(1 − x), where the
// form without it, which is an irradiance, ends at half of that.
void add_part(uint first, Frame frame, vec3 strength, vec3 way, vec3 normal, float area_over_pi) {
    float squared = dot(way, way) + 1e-20;
    vec3 direction = way * inversesqrt(squared);
    float nearness = 2.0 / (1.0 + sqrt(squared / (squared + area_over_pi)));
    float form = nearness * max(-dot(normal, direction), 0.0) / (squared + area_over_pi);
    vec3 local = half_direction(frame, direction);
    int level = level_of_angle(PI * area_over_pi * form, max(local.z, 1e-3));
    Corners corners = corners_of(square_of_direction(local), level);
    [[dont_unroll]] for (int corner = 0; corner < 4; ++corner) {
        add_to_texel(first, corners.texels[corner], corners.weights[corner] * form * strength);
    }
}

// A square of the light's area, in parts that are no wider than a texel.
void add_parts(uint first, Frame frame, MapHorizon horizon, Vpl light, vec3 position_rs, float factor) {
    vec3 normal = normalize(light.normal);
    vec3 way = light.position_rs - position_rs;
    float side = sqrt(PI * light.area_over_pi);
    float view_cosine = max(half_direction(frame, normalize(way)).z, 0.05);
    float width = side * inversesqrt(dot(way, way) + 1e-20) / (2.0 * view_cosine);
    int parts = clamp(int(ceil(width * inversesqrt(texel_angle(0)))), 1, MOST_PARTS);
    Frame tile = frame_around(normal);
    float share = 1.0 / float(parts * parts);
    vec3 strength = factor * share * length(light.normal) * light.strength;
    [[dont_unroll]] for (int part = 0; part < parts * parts; ++part) {
        vec2 place = ((vec2(part % parts, part / parts) + 0.5) / float(parts) - 0.5) * side;
        vec3 off = place.x * tile.tangent + place.y * tile.bitangent;
        if (is_before(horizon, way + off)) {
            add_part(first, frame, strength, way + off, normal, share * light.area_over_pi);
        }
    }
}

void add_light(uint first, Frame frame, MapHorizon horizon, Vpl light, vec3 position_rs, float factor) {
    vec3 direction;
    vec3 amount = factor * point_light_from(light, position_rs, direction);
    if (max3(amount) <= 0.0) {
        return;
    }
    if (FILL == FILL_FOOTPRINT) {
        add_parts(first, frame, horizon, light, position_rs, factor);
    } else if (is_before(horizon, light.position_rs - position_rs)) {
        vec2 square = square_of_direction(half_direction(frame, direction));
        ivec2 texel = clamp(ivec2(square * float(MAP_SIDE)), ivec2(0), ivec2(MAP_SIDE - 1));
        add_to_texel(first, texel.y * MAP_SIDE + texel.x, amount);
    }
}

void write_map() {
    uint self = gl_LocalInvocationIndex;
    uint map = map_of_group();
    if (map >= min(texelFetch(map_head, 3).x, push.capacity)) {
        return;
    }
    uint first = map * 3u * uint(MAP_TEXELS);
    if (CACHED != 0u) {
        for (uint word = self; word < 3u * uint(MAP_TEXELS); word += 64u) {
            held[word] = 0u;
        }
    } else if (push.first_group == 0) {
        for (uint word = self; word < 3u * uint(MAP_TEXELS); word += 64u) {
            sums[first + word] = 0u;
        }
        memoryBarrierBuffer();
    }
    barrier();
    uint cache = texelFetch(map_caches, int(map)).x;
    vec3 position_rs = position_of_cache(cache);
    MapHorizon horizon = horizon_of(cascades, uvec3(horizons[3u * cache], horizons[3u * cache + 1u], horizons[3u * cache + 2u]));
    Frame frame = frame_around(direction_to_eye(camera, position_rs));
    float scale = scale_of_bound(texelFetch(map_bounds, int(map)).x);
    int end = min(push.end_group, int(texelFetch(area_light_counts, 1).x));
    for (int index = push.first_group + int(self); index < end; index += 64) {
        LightGroup group = load_light_group(area_light_groups, index);
        int target = target_of(group, uint(index), horizon, position_rs);
        if (target >= 0) {
            float visibility = visibility_of_group(push.rays, group, load_area_light(target), position_rs);
            for (int number = group.first; number < group.end && visibility > 0.0; ++number) {
                add_light(first, frame, horizon, load_area_light(number), position_rs, scale * visibility);
            }
        }
    }
    if (CACHED != 0u) {
        barrier();
        for (uint word = self; word < 3u * uint(MAP_TEXELS); word += 64u) {
            sums[first + word] = push.first_group == 0 ? held[word] : sums[first + word] + held[word];
        }
    }
}

#endif
