#version 460
#include "lib/prelude.glsl"
#include "caches/asking.glsl"
#include "caches/elect.glsl"
#include "caches/moves.glsl"
#include "lib/octahedral.glsl"

// One invocation a pixel moves caches that lie behind its surface, or less than MARGIN cells before it, to that distance in front. About half of all caches lie behind the
// surfaces that ask for them (Reich 2015, appendix A), where walls hide the lights. Along each of six axes the longest way that a pixel asks for counts: in a corner
// a cache gets in front of both walls, and a maximum does not depend on the order of pixels. Along walls that stand askew to the axes one way takes from another: what
// is still behind moves again in a second round.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform usamplerBuffer addresses;
layout(set = 0, binding = 1) uniform samplerBuffer positions;
layout(set = 0, binding = 2) buffer MoveBlock { uint moves[]; };

layout(push_constant, scalar) uniform Push {
    Cascades cascades;
    uint capacity;
} push;

void move(uint address, vec3 position_rs, vec3 normal) {
    uint index = texelFetch(addresses, int(address)).x - 1u;
    if (index >= push.capacity) {
        return;
    }
    float cell = cell_of_cascade(push.cascades, cascade_of_address(push.cascades, address));
    float height = dot(normal, texelFetch(positions, int(index)).xyz - position_rs) / cell;
    vec3 way = clamp(MARGIN - height, 0.0, LONGEST_MOVE) * normal;
    for (int axis = 0; axis < 3; ++axis) {
        uint steps = uint(abs(way[axis]) * MOVE_STEPS + 0.5);
        if (steps > 0u) {
            atomicMax(moves[6u * index + 2u * uint(axis) + (way[axis] < 0.0 ? 1u : 0u)], steps);
        }
    }
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = textureSize(depth, 0);
    Asking asking = asking_of_pixel(push.cascades, pixel, size);
    uint packed_normal = asking.asks ? texelFetch(surface, pixel, 0).y : 0u;
    vec3 normal = unpack_direction(packed_normal);
    normal = dot(normal, direction_to_eye(camera, asking.position_rs)) < 0.0 ? -normal : normal;
    [[dont_unroll]] for (int step = 0; step < 2; ++step) {
        bool asks = asking.asks && (step == 0 || asking.in_both);
        Place place = place_in(push.cascades, asking.cascade + (asks ? step : 0), asking.position_rs);
        uint lowest = address_of(push.cascades, place.cascade, place.lowest);
        if (elect(uvec2(asks ? lowest : NO_ADDRESS, packed_normal))) {
            [[dont_unroll]] for (int corner = 0; corner < 8; ++corner) {
                move(address_of(push.cascades, place.cascade, place.lowest + corner_of(corner)), asking.position_rs, normal);
            }
        }
    }
}
