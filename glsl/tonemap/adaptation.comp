#version 460
#include "lib/prelude.glsl"
#include "tonemap/adaptation.glsl"

// One group adds up the blocks: the image's logarithmic average and maximum luminance, in W/(m²·sr).
// Fixed order: the same bits every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer Blocks { BlockLuminance blocks[]; };
layout(set = 0, binding = 1) readonly buffer LogSums { float log_sums[]; };
layout(set = 0, binding = 2) writeonly buffer AdaptationBlock { Adaptation adaptation; };

layout(push_constant, scalar) uniform Push {
    uint block_count;
    uint pixel_count;
} push;

shared vec2 partial[64];

void main() {
    uint self = gl_LocalInvocationIndex;
    float log_sum = 0.0;
    float maximum = 0.0;
    for (uint block = self; block < push.block_count; block += 64u) {
        log_sum += log_sums[block];
        maximum = max(maximum, blocks[block].maximum);
    }
    partial[self] = vec2(log_sum, maximum);
    barrier();
    [[dont_unroll]] for (uint stride = 32u; stride > 0u; stride /= 2u) {
        if (self < stride) {
            vec2 above = partial[self + stride];
            partial[self] = vec2(partial[self].x + above.x, max(partial[self].y, above.y));
        }
        barrier();
    }
    if (self == 0u) {
        adaptation.log_average = exp(partial[0].x / float(push.pixel_count));
        adaptation.maximum = partial[0].y;
    }
}
