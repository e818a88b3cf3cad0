#version 460
#include "lib/prelude.glsl"
#include "lib/color.glsl"
#include "tonemap/adaptation.glsl"

// One group takes one block of consecutive pixels (64·pixels_per_invocation in row order): the sum and the maximum of their luminance.
// A binary tree of fixed shape adds up: the same bits every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1) writeonly buffer Blocks { BlockLuminance blocks[]; };

layout(push_constant, scalar) uniform Push { uint pixels_per_invocation; } push;

shared BlockLuminance partial[64];

void main() {
    uint self = gl_LocalInvocationIndex;
    ivec2 size = textureSize(image, 0);
    uint first = gl_WorkGroupID.x * 64u * push.pixels_per_invocation + self;
    BlockLuminance own = BlockLuminance(0.0, 0.0);
    for (uint i = 0u; i < push.pixels_per_invocation; ++i) {
        int index = int(first + 64u * i);
        ivec2 pixel = ivec2(index % size.x, index / size.x);
        if (pixel.y < size.y) {
            float value = max(luminance(texelFetch(image, pixel, 0).rgb), 0.0);
            own = BlockLuminance(own.sum + value, max(own.maximum, value));
        }
    }
    partial[self] = own;
    barrier();
    [[dont_unroll]] for (uint stride = 32u; stride > 0u; stride /= 2u) {
        if (self < stride) {
            BlockLuminance above = partial[self + stride];
            partial[self] = BlockLuminance(partial[self].sum + above.sum, max(partial[self].maximum, above.maximum));
        }
        barrier();
    }
    if (self == 0u) {
        blocks[gl_WorkGroupID.x] = partial[0];
    }
}
