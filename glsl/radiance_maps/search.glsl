// The light of one map, texel by texel. The including file has visibility_of_group() and groups of 64 invocations.
#ifndef RADIANCE_MAPS_SEARCH
#define RADIANCE_MAPS_SEARCH

#include "groups/light_caches.glsl"
#include "groups/surface.glsl"
#include "caches/rays.glsl"
#include "radiance_maps/map.glsl"
#include "radiance_maps/of_map.glsl"
#include "radiance_maps/target.glsl"

// One group of invocations a map: each texel of its finest level looks for the lights that its beam meets, and is written once (Reich 2015, section 6.3, names it),
//
//   E = Σ_g V_g Σ_{i in g} L_i · W · C_i        L_i = Φ_i/(π A_i), W/m²
//
// W the solid angle of the texel's directions, C_i the part of them that ends within the light, a square of its area. On the light's plane the beam is a parallelogram, and is taken
// for a box that varies as much along the edges of the square. So a texel shows what is in it however large a light is: near lights leave no holes, and far ones that are
// smaller than a texel are met by the part of it that they fill.
//
// Groups of lights that the beam passes by are left out by their spheres. Of 64 groups at a time each invocation first finds how much of one is seen.

layout(set = 0, binding = 0) uniform usamplerBuffer map_head;
layout(set = 0, binding = 1) uniform usamplerBuffer map_caches;
layout(set = 0, binding = 2) uniform samplerBuffer tables;  // of each texel the middle h and W
layout(set = 0, binding = 3) buffer MapBlock { vec4 maps[]; };
layout(set = 0, binding = 4) readonly buffer HorizonBlock { uint horizons[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    int first_group;
    int end_group;
    int first_texel;  // multiples of 64
    int end_texel;
    uint capacity;
} push;

// A group's sphere is two deviations of its lights: corners of their squares may lie beyond.
const float SPHERE_REACH = 1.3;

shared float seen[64];

// The directions of one texel.
struct Beam {
    vec3 direction;
    vec3 across;   // from one of its edges to the other one
    vec3 along;
    float width;   // half of a diagonal at most
    float angle;   // W
};

vec3 middle_of_texel(ivec2 place) {
    ivec2 texel = clamp(place, ivec2(0), ivec2(MAP_SIDE - 1));
    return texelFetch(tables, texel.y * MAP_SIDE + texel.x).xyz;
}

// ω = 2(v·h)h − v changes by 2((v·dh)h + (v·h)dh).
vec3 turn(Frame frame, vec3 h, vec3 change) {
    return to_world(frame, 2.0 * (change.z * h + h.z * change));
}

Beam beam_of(Frame frame, int texel) {
    ivec2 place = ivec2(texel % MAP_SIDE, texel / MAP_SIDE);
    vec4 known = texelFetch(tables, texel);
    vec3 h = known.xyz;
    // At the map's edge there is one neighbour.
    vec2 steps = vec2(min(place + 1, ivec2(MAP_SIDE - 1)) - max(place - 1, ivec2(0)));
    vec3 across = (middle_of_texel(place + ivec2(1, 0)) - middle_of_texel(place - ivec2(1, 0))) / steps.x;
    vec3 along = (middle_of_texel(place + ivec2(0, 1)) - middle_of_texel(place - ivec2(0, 1))) / steps.y;
    Beam beam;
    beam.direction = to_world(frame, 2.0 * h.z * h - vec3(0.0, 0.0, 1.0));
    beam.across = turn(frame, h, across);
    beam.along = turn(frame, h, along);
    beam.width = 0.5 * (length(beam.across) + length(beam.along));
    beam.angle = known.w;
    return beam;
}

bool may_meet(Beam beam, vec3 to_center, float radius) {
    float ahead = dot(to_center, beam.direction);
    float reach = SPHERE_REACH * radius + beam.width * max(ahead, 0.0);
    return ahead > -SPHERE_REACH * radius && dot(to_center, to_center) - ahead * ahead <= reach * reach;
}

// How much of a box of this width around a place lies within a square of this side, along one axis.
float share_within(float place, float width, float side) {
    float low = max(place - 0.5 * width, -0.5 * side);
    float high = min(place + 0.5 * width, 0.5 * side);
    return clamp((high - low) / max(width, 1e-30), 0.0, 1.0);
}

// The part of the beam that ends within the light before the horizon. Seen from its back it shows nothing.
float part_within(Beam beam, Vpl disc, vec3 way, MapHorizon horizon) {
    float facing = dot(disc.normal, beam.direction);
    float height = dot(disc.normal, way);
    if (facing >= -1e-6 || height >= 0.0) {
        return 0.0;
    }
    float distance = height / facing;
    vec3 end = distance * beam.direction;
    if (!is_before(horizon, end)) {
        return 0.0;
    }
    vec3 across = distance * (beam.across - (dot(disc.normal, beam.across) / facing) * beam.direction);
    vec3 along = distance * (beam.along - (dot(disc.normal, beam.along) / facing) * beam.direction);
    Frame tile = frame_around(disc.normal);
    vec2 place = vec2(dot(end - way, tile.tangent), dot(end - way, tile.bitangent));
    vec2 first = vec2(dot(across, tile.tangent), dot(across, tile.bitangent));
    vec2 second = vec2(dot(along, tile.tangent), dot(along, tile.bitangent));
    vec2 width = sqrt(first * first + second * second);
    float side = sqrt(PI * disc.area_over_pi);
    return share_within(place.x, width.x, side) * share_within(place.y, width.y, side);
}

vec3 light_in_beam(Beam beam, LightGroup group, MapHorizon horizon, vec3 position_rs) {
    vec3 light = vec3(0.0);
    for (int number = group.first; number < group.end; ++number) {
        Vpl area_light = load_area_light(number);
        float size = inversesqrt(dot(area_light.normal, area_light.normal));
        Vpl disc = Vpl(area_light.position_rs, area_light.area_over_pi, area_light.strength / size, area_light.normal * size);
        float part = part_within(beam, disc, disc.position_rs - position_rs, horizon);
        light += part / (PI * disc.area_over_pi) * disc.strength;
    }
    return beam.angle * light;
}

void search_map() {
    int self = int(gl_LocalInvocationIndex);
    uint map = map_of_group();
    if (map >= min(texelFetch(map_head, 3).x, push.capacity)) {
        return;
    }
    uint cache = texelFetch(map_caches, int(map)).x;
    vec3 position_rs = position_of_cache(cache);
    MapHorizon horizon = horizon_of(cascades, uvec3(horizons[3u * cache], horizons[3u * cache + 1u], horizons[3u * cache + 2u]));
    Frame frame = frame_around(direction_to_eye(camera, position_rs));
    uint first_texel = map * uint(MAP_TEXELS);
    int end = min(push.end_group, int(texelFetch(area_light_counts, 1).x));
    if (push.first_group == 0) {
        for (int texel = push.first_texel + self; texel < push.end_texel; texel += 64) {
            maps[first_texel + uint(texel)] = vec4(0.0);
        }
    }
    for (int first = push.first_group; first < end; first += 64) {
        barrier();
        seen[self] = 0.0;
        if (first + self < end) {
            LightGroup group = load_light_group(area_light_groups, first + self);
            int target = target_of(group, uint(first + self), horizon, position_rs);
            if (target >= 0) {
                seen[self] = visibility_of_group(push.rays, group, load_area_light(target), position_rs);
            }
        }
        barrier();
        for (int texel = push.first_texel + self; texel < push.end_texel; texel += 64) {
            Beam beam = beam_of(frame, texel);
            vec3 light = vec3(0.0);
            for (int number = first; number < min(first + 64, end); ++number) {
                float visibility = seen[number - first];
                if (visibility > 0.0) {
                    LightGroup group = load_light_group(area_light_groups, number);
                    if (may_meet(beam, group.center_rs - position_rs, group.radius)) {
                        light += visibility * light_in_beam(beam, group, horizon, position_rs);
                    }
                }
            }
            if (max3(light) > 0.0) {
                maps[first_texel + uint(texel)].rgb += light;
            }
        }
    }
}

#endif
