#version 460
#include "lib/prelude.glsl"
#include "ism/pyramid.glsl"
#include "lib/vectors.glsl"

// The last push: one texel of the maps as they are looked up, what was drawn or, in a hole, what lies around it. A place of which too little
// is known stays empty: nothing is there.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer drawn;
layout(set = 0, binding = 1) uniform samplerBuffer coarse;
layout(set = 0, binding = 2) uniform samplerBuffer area_before;
layout(set = 0, binding = 3) writeonly buffer Maps { float maps[]; };

layout(push_constant, scalar) uniform Push {
    uint vpl_count;
    uint side;
    uint coarse_side;
    uint points_of_set;
    uint block_count;
} push;

const float LEAST_KNOWN = 0.15;

// Surfaces are pushed back, lest those that meet in a corner shadow each other: by so many texels as an angle, but no further than so many times
// the radius of a point's disc, which is how well its place is known.
const float SLACK_TEXELS = 5.0;
const float SLACK_DISCS = 2.0;

void main() {
    ivec2 texel;
    if (!texel_of_map(texel, push.side)) {
        return;
    }
    float area = texelFetch(area_before, int(push.block_count)).x / float(push.points_of_set);
    float most_slack = SLACK_DISCS * sqrt(area * INVERSE_PI);
    for (uint k = gl_WorkGroupID.y; k < push.vpl_count; k += gl_NumWorkGroups.y) {
        int place = place_in_maps(k, texel, push.side);
        float inverse = texelFetch(drawn, place).x;
        if (inverse <= 0.0) {
            vec2 around = interpolated(coarse, k, texel, push.coarse_side);
            inverse = around.y >= LEAST_KNOWN ? around.x : 0.0;
        }
        maps[place] = inverse / (1.0 + min(SLACK_TEXELS / float(push.side), most_slack * inverse));
    }
}
