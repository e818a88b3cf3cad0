#version 460
#include "lib/prelude.glsl"

// One more than in the last frame.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform usampler2D last;
layout(set = 0, binding = 1, r32ui) writeonly uniform uimage2D next;

layout(push_constant, scalar) uniform Push { uint step; } push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(next)))) {
        imageStore(next, texel, texelFetch(last, texel, 0) + push.step);
    }
}
