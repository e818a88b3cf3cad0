#version 460
#include "lib/prelude.glsl"
#include "lib/color.glsl"
#include "lib/vectors.glsl"

// One group counts the lit slots of each group of slots: offsets[g] = the lit slots and the groups with any that come before group g. Behind them all come the totals, which
// `counts` has too.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform samplerBuffer slots;
layout(set = 0, binding = 1) writeonly buffer OffsetBlock { uvec2 offsets[]; };
layout(set = 0, binding = 2) writeonly buffer CountBlock { uint counts[]; };

layout(push_constant, scalar) uniform Push {
    uint group_count;
    uint group_slots;
} push;

#define SCAN_TYPE uvec2

uvec2 scan_term(uint group) {
    uint lit = 0u;
    for (uint slot = group * push.group_slots; slot < (group + 1u) * push.group_slots; ++slot) {
        lit += max3(texelFetch(slots, int(2u * slot + 1u)).rgb) > 0.0 ? 1u : 0u;
    }
    return uvec2(lit, min(lit, 1u));
}

void scan_store(uint group, uvec2 before) {
    offsets[group] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.group_count);
    if (gl_LocalInvocationIndex == 0u) {
        uvec2 total = scan_total();
        counts[0] = total.x;
        counts[1] = total.y;
    }
}
