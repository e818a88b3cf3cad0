#version 460
#include "lib/prelude.glsl"
#include "caches/asks.glsl"
#include "caches/cascades.glsl"
#include "caches/moves.glsl"

// One invocation for each node that is asked for moves its cache if it lies behind the surface, or less than MARGIN cells before it, to that distance in front. About half of
// all caches lie behind the surfaces that ask for them (Reich 2015, appendix A), where walls hide the lights. Along each of six axes the longest way that somebody asks
// for counts: in a corner a cache gets in front of both walls, and a maximum does not depend on the order. Along walls that stand askew to the axes one way takes from
// another: what is still behind moves again in a second round.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer AskBlock { Ask asks[]; };
layout(set = 0, binding = 1) uniform usamplerBuffer ask_head;
layout(set = 0, binding = 2) uniform usamplerBuffer addresses;
layout(set = 0, binding = 3) uniform samplerBuffer positions;
layout(set = 0, binding = 4) buffer MoveBlock { uint moves[]; };

layout(push_constant, scalar) uniform Push {
    Cascades cascades;
    uint ask_capacity;
    uint capacity;
} push;

void main() {
    uint number = ask_of_invocation();
    if (number >= min(texelFetch(ask_head, 3).x, push.ask_capacity)) {
        return;
    }
    Ask ask = asks[number];
    uint address = node_of_ask(ask, push.cascades.resolution, int(gl_LocalInvocationIndex % 8u));
    uint index = texelFetch(addresses, int(address)).x - 1u;
    if (index >= push.capacity) {
        return;
    }
    float cell = cell_of_cascade(push.cascades, cascade_of_address(push.cascades, address));
    float height = dot(ask.normal, texelFetch(positions, int(index)).xyz - ask.position_rs) / cell;
    vec3 way = clamp(MARGIN - height, 0.0, LONGEST_MOVE) * ask.normal;
    for (int axis = 0; axis < 3; ++axis) {
        uint steps = uint(abs(way[axis]) * MOVE_STEPS + 0.5);
        uint word = 6u * index + 2u * uint(axis) + (way[axis] < 0.0 ? 1u : 0u);
        // Most ask for no more than others did before.
        if (steps > 0u && moves[word] < steps) {
            atomicMax(moves[word], steps);
        }
    }
}
