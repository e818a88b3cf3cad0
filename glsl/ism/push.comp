#version 460
#include "lib/prelude.glsl"
#include "ism/pyramid.glsl"

// Push: one texel of a level of the maps, completed from the next coarser level as far as it is unknown (glsl/ism/pyramid.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer pulled;
layout(set = 0, binding = 1) uniform samplerBuffer coarse;
layout(set = 0, binding = 2) writeonly buffer Pushed { vec2 pushed[]; };

layout(push_constant, scalar) uniform Push {
    uint vpl_count;
    uint side;
    uint coarse_side;
} push;

void main() {
    ivec2 texel;
    if (!texel_of_map(texel, push.side)) {
        return;
    }
    for (uint k = gl_WorkGroupID.y; k < push.vpl_count; k += gl_NumWorkGroups.y) {
        int place = place_in_maps(k, texel, push.side);
        vec2 known = texelFetch(pulled, place).xy;
        vec2 around = interpolated(coarse, k, texel, push.coarse_side);
        vec2 shares = vec2(known.y, (1.0 - known.y) * around.y);
        float share = shares.x + shares.y;
        pushed[place] = vec2((shares.x * known.x + shares.y * around.x) / max(share, 1e-6), share);
    }
}
