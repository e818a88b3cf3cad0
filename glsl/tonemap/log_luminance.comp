#version 460
#include "lib/prelude.glsl"
#include "lib/color.glsl"
#include "tonemap/adaptation.glsl"

// One group takes the same block as tonemap/luminance: Σ ln L over its pixels with L > 10⁻³·mean, and how many these are. Every group adds up the blocks'
// sums for the mean, in the same order.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1) readonly buffer Blocks { BlockLuminance blocks[]; };
layout(set = 0, binding = 2) writeonly buffer LogSums { LogSum log_sums[]; };

layout(push_constant, scalar) uniform Push {
    uint pixels_per_invocation;
    uint block_count;
} push;

shared LogSum partial[64];

void add_up(uint self) {
    barrier();
    [[dont_unroll]] for (uint stride = 32u; stride > 0u; stride /= 2u) {
        if (self < stride) {
            partial[self] = LogSum(partial[self].sum + partial[self + stride].sum, partial[self].count + partial[self + stride].count);
        }
        barrier();
    }
}

void main() {
    uint self = gl_LocalInvocationIndex;
    ivec2 size = textureSize(image, 0);
    float sum = 0.0;
    for (uint block = self; block < push.block_count; block += 64u) {
        sum += blocks[block].sum;
    }
    partial[self] = LogSum(sum, 0.0);
    add_up(self);
    float mean = partial[0].sum / (float(size.x) * float(size.y));
    float dark = max(DARK_SHARE_OF_MEAN * mean, SMALLEST_LUMINANCE);
    barrier();

    uint first = gl_WorkGroupID.x * 64u * push.pixels_per_invocation + self;
    LogSum own = LogSum(0.0, 0.0);
    for (uint i = 0u; i < push.pixels_per_invocation; ++i) {
        int index = int(first + 64u * i);
        ivec2 pixel = ivec2(index % size.x, index / size.x);
        if (pixel.y < size.y) {
            float value = luminance(texelFetch(image, pixel, 0).rgb);
            if (value > dark) {
                own = LogSum(own.sum + log(value), own.count + 1.0);
            }
        }
    }
    partial[self] = own;
    add_up(self);
    if (self == 0u) {
        log_sums[gl_WorkGroupID.x] = partial[0];
    }
}
