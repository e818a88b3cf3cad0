#version 460
#include "lib/prelude.glsl"
#include "caches/pyramid.glsl"

// Whether a light, and a group of lights, begins with one slot: nodes of the pyramid that matter no more than a bound, or slots themselves, and whose parents matter more. So
// lights are small where they give the picture much. Bit 0: a light; bits 4 to 7 its level. Bit 1: a group, which is a cut of the same kind at another bound and so holds
// whole lights; bits 8 to 11 its level.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer matter;
layout(set = 0, binding = 1) uniform samplerBuffer total;
layout(set = 0, binding = 2) writeonly buffer CutBlock { uint cuts[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint last_level;
    float light_bound;
    float group_bound;
} push;

vec2 node_of(uint slot, uint level) {
    return texelFetch(matter, int(first_of_level(push.slot_count, level) + (slot >> (2u * level)))).xy;
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.slot_count) {
        return;
    }
    vec2 all = texelFetch(total, 0).xy;
    uint light_level = 0u;
    uint group_level = 0u;
    [[dont_unroll]] for (uint level = 1u; level <= push.last_level; ++level) {
        float weight = matter_of(node_of(slot, level), all);
        light_level = weight <= push.light_bound ? level : light_level;
        group_level = weight <= push.group_bound ? level : group_level;
    }
    bool light = (slot & ((1u << (2u * light_level)) - 1u)) == 0u && node_of(slot, light_level).y > 0.0;
    bool group = (slot & ((1u << (2u * group_level)) - 1u)) == 0u && node_of(slot, group_level).y > 0.0;
    cuts[slot] = (light ? 1u : 0u) | (group ? 2u : 0u) | light_level << 4 | group_level << 8;
}
