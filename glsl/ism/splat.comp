#version 460
#include "lib/prelude.glsl"
#include "ism/map.glsl"
#include "lib/vpl.glsl"

// One invocation draws one point of the scene's surfaces into the map of one VPL (Ritschel et al. 2008). The point stands for a disc in its
// triangle's plane, of the area that the points of a set share; it covers the texels whose centres see it, and in any case
// the one that it lies in. Each keeps the nearest surface: an atomic maximum of the inverse distance [1/m], whose bits order as its values.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer vpls;
layout(set = 0, binding = 1) uniform samplerBuffer points;
layout(set = 0, binding = 2) uniform samplerBuffer area_before;
layout(set = 0, binding = 3) buffer Drawn { uint drawn[]; };

layout(push_constant, scalar) uniform Push {
    uint vpl_count;
    uint points_of_set;
    uint set_count;
    uint resolution;
    uint block_count;
} push;

// Discs overlap, so that fewer texels stay empty between them.
const float DISC_SHARE = 1.5;

void draw_point(uint k, vec4 texel, Vpl vpl, float disc_radius) {
    vec3 normal = normalize(vpl.normal);
    vec3 position = to_map_frame(normal, texel.xyz - vpl.position_rs);
    vec3 plane = to_map_frame(normal, normalize(unpack_direction_in_float_unnormalized(texel.w)));
    float distance = length(position);
    float height = dot(plane, position);
    // Below the map, or so close to edge-on that it hides nothing: the VPL's own surface is.
    if (distance + position.z <= 0.3 * distance || abs(height) <= 0.01 * distance) {
        return;
    }
    float resolution = float(push.resolution);
    vec2 center = position.xy / (distance + position.z);
    float extent = min(disc_radius / distance, 2.0) * 0.6 * (1.0 + dot(center, center));
    ivec2 last = ivec2(int(push.resolution) - 1);
    ivec2 own = ivec2(floor((0.5 * center + 0.5) * resolution));
    ivec2 low = clamp(ivec2(floor((0.5 * (center - extent) + 0.5) * resolution)), ivec2(0), last);
    ivec2 high = clamp(ivec2(floor((0.5 * (center + extent) + 0.5) * resolution)), ivec2(0), last);
    uint first = k * push.resolution * push.resolution;
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            vec3 direction = direction_of_map(center_of_texel(ivec2(x, y), resolution));
            float inverse = dot(plane, direction) / height;
            vec3 off = direction - inverse * position;
            bool sees = dot(off, off) <= disc_radius * disc_radius * inverse * inverse;
            if (inverse > 0.0 && (sees || ivec2(x, y) == own)) {
                float bounded = min(inverse, 2.0 / distance);
                atomicMax(drawn[first + uint(y) * push.resolution + uint(x)], floatBitsToUint(bounded));
            }
        }
    }
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.points_of_set) {
        return;
    }
    float area = texelFetch(area_before, int(push.block_count)).x / float(push.points_of_set);
    float disc_radius = sqrt(area * (DISC_SHARE * INVERSE_PI));
    for (uint k = gl_WorkGroupID.y; k < push.vpl_count; k += gl_NumWorkGroups.y) {
        Vpl vpl = unpack_vpl(texelFetch(vpls, 2 * int(k)), texelFetch(vpls, 2 * int(k) + 1));
        vec4 texel = texelFetch(points, int((k % push.set_count) * push.points_of_set + number));
        if (max3(vpl.strength) > 0.0 && texel.w > 0.0) {
            draw_point(k, texel, vpl, disc_radius);
        }
    }
}
