#version 460
#include "lib/prelude.glsl"
#include "tonemap/adaptation.glsl"

// One group adds up the blocks: the image's logarithmic average and maximum luminance, in W/(m²·sr).
// Fixed order: the same bits every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer Blocks { BlockLuminance blocks[]; };
layout(set = 0, binding = 1) readonly buffer LogSums { LogSum log_sums[]; };
layout(set = 0, binding = 2) writeonly buffer AdaptationBlock { Adaptation adaptation; };

layout(push_constant, scalar) uniform Push { uint block_count; } push;

shared vec3 partial[64];

void main() {
    uint self = gl_LocalInvocationIndex;
    LogSum own = LogSum(0.0, 0.0);
    float maximum = 0.0;
    for (uint block = self; block < push.block_count; block += 64u) {
        own = LogSum(own.sum + log_sums[block].sum, own.count + log_sums[block].count);
        maximum = max(maximum, blocks[block].maximum);
    }
    partial[self] = vec3(own.sum, own.count, maximum);
    barrier();
    [[dont_unroll]] for (uint stride = 32u; stride > 0u; stride /= 2u) {
        if (self < stride) {
            vec3 above = partial[self + stride];
            partial[self] = vec3(partial[self].xy + above.xy, max(partial[self].z, above.z));
        }
        barrier();
    }
    if (self == 0u) {
        adaptation.log_average = partial[0].y > 0.0 ? exp(partial[0].x / partial[0].y) : 0.0;
        adaptation.maximum = partial[0].z;
    }
}
