#version 460
#include "lib/prelude.glsl"
#include "caches/pyramid.glsl"

// One node of a coarser level of what slots matter is the sum of its four.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer MatterBlock { vec2 matter[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint level;  // that is made, from 1 on
} push;

void main() {
    uint node = gl_GlobalInvocationID.x;
    if (node >= push.slot_count >> (2u * push.level)) {
        return;
    }
    uint finer = first_of_level(push.slot_count, push.level - 1u) + 4u * node;
    matter[first_of_level(push.slot_count, push.level) + node] =
        (matter[finer] + matter[finer + 1u]) + (matter[finer + 2u] + matter[finer + 3u]);
}
