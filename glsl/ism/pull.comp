#version 460
#include "lib/prelude.glsl"
#include "ism/pyramid.glsl"

// Pull: one texel of a level of the maps from the four below it (glsl/ism/pyramid.glsl).

layout(local_size_x = 64) in;

// 1: the level below is what was drawn: an inverse distance a texel, 0 for an empty one.
layout(constant_id = 0) const uint FROM_DRAWN = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer fine;
layout(set = 0, binding = 1) writeonly buffer Coarse { vec2 coarse[]; };

layout(push_constant, scalar) uniform Push {
    uint vpl_count;
    uint fine_side;
    uint coarse_side;
} push;

void main() {
    ivec2 texel;
    if (!texel_of_map(texel, push.coarse_side)) {
        return;
    }
    for (uint k = gl_WorkGroupID.y; k < push.vpl_count; k += gl_NumWorkGroups.y) {
        vec2 sum = vec2(0.0);
        [[dont_unroll]] for (int i = 0; i < 4; ++i) {
            ivec2 below = 2 * texel + ivec2(i & 1, i >> 1);
            if (max(below.x, below.y) < int(push.fine_side)) {
                vec4 known = texelFetch(fine, place_in_maps(k, below, push.fine_side));
                float share = FROM_DRAWN != 0u ? (known.x > 0.0 ? 1.0 : 0.0) : known.y;
                sum += share * vec2(known.x, 1.0);
            }
        }
        coarse[place_in_maps(k, texel, push.coarse_side)] = vec2(sum.x / max(sum.y, 1e-6), 0.25 * sum.y);
    }
}
