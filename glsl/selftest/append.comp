#version 460
#include "lib/prelude.glsl"

// One texel becomes 10·texel + digit: the order of several writers of one image can be read off it.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, r32ui) uniform uimage2D image;

layout(push_constant, scalar) uniform Push { uint digit; } push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(image)))) {
        imageStore(image, texel, uvec4(10u * imageLoad(image, texel).x + push.digit));
    }
}
