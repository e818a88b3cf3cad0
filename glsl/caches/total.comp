#version 460
#include "lib/prelude.glsl"
#include "caches/pyramid.glsl"

// One group adds up what all slots matter, from the nodes of the last level.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform samplerBuffer matter;
layout(set = 0, binding = 1) writeonly buffer TotalBlock { vec2 total[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint level;
} push;

#define SCAN_TYPE vec2

vec2 scan_term(uint node) {
    return texelFetch(matter, int(first_of_level(push.slot_count, push.level) + node)).xy;
}

void scan_store(uint node, vec2 before) {
}

#include "lib/prefix_scan.glsl"

void main() {
    scan_sum_before_run(push.slot_count >> (2u * push.level));
    if (gl_LocalInvocationIndex == 0u) {
        total[0] = scan_total();
    }
}
