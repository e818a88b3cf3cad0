#version 460
#include "lib/prelude.glsl"
#include "ism/pyramid.glsl"

// The last push: one texel of the maps as they are looked up, what was drawn or, in a hole, what lies around it. A place of which too little
// is known stays empty: nothing is there.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer drawn;
layout(set = 0, binding = 1) uniform samplerBuffer coarse;
layout(set = 0, binding = 2) writeonly buffer Maps { float maps[]; };

layout(push_constant, scalar) uniform Push {
    uint vpl_count;
    uint side;
    uint coarse_side;
} push;

const float LEAST_KNOWN = 0.3;

void main() {
    ivec2 texel;
    if (!texel_of_map(texel, push.side)) {
        return;
    }
    for (uint k = gl_WorkGroupID.y; k < push.vpl_count; k += gl_NumWorkGroups.y) {
        int place = place_in_maps(k, texel, push.side);
        float inverse = texelFetch(drawn, place).x;
        if (inverse <= 0.0) {
            vec2 around = interpolated(coarse, k, texel, push.coarse_side);
            inverse = around.y >= LEAST_KNOWN ? around.x : 0.0;
        }
        maps[place] = inverse;
    }
}
