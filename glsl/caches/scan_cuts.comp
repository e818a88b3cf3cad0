#version 460
#include "lib/prelude.glsl"

// One group counts the lights and groups of lights that begin before each slot (caches/cut.comp). Behind all come the totals, which `counts` has too.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer cuts;
layout(set = 0, binding = 1) writeonly buffer OffsetBlock { uvec2 offsets[]; };
layout(set = 0, binding = 2) writeonly buffer CountBlock { uint counts[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint group_count;  // that there is room for
} push;

#define SCAN_TYPE uvec2

uvec2 scan_term(uint slot) {
    uint cut = texelFetch(cuts, int(slot)).x;
    return uvec2(cut & 1u, cut >> 1 & 1u);
}

void scan_store(uint slot, uvec2 before) {
    offsets[slot] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.slot_count);
    if (gl_LocalInvocationIndex == 0u) {
        uvec2 total = scan_total();
        counts[0] = total.x;
        counts[1] = min(total.y, push.group_count);
    }
}
