#version 460
#include "lib/prelude.glsl"

// One group turns the counts of the buckets into where each starts: bucket_starts[b] = Σ_{c<b} bucket_counts[c], the total at the end.
// Each invocation sums a run of buckets, the group scans the 256 sums (Hillis & Steele 1986), each invocation walks its run again.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer bucket_counts;
layout(set = 0, binding = 1) writeonly buffer StartBlock { uint bucket_starts[]; };

layout(push_constant, scalar) uniform Push {
    uint bucket_count;  // a multiple of 256
    uint reserved;
} push;

shared uint sums[256];

void main() {
    uint self = gl_LocalInvocationIndex;
    uint run = push.bucket_count / 256u;
    uint first = self * run;
    uint sum = 0u;
    for (uint bucket = first; bucket < first + run; ++bucket) {
        sum += texelFetch(bucket_counts, int(bucket)).x;
    }
    sums[self] = sum;
    barrier();
    [[dont_unroll]] for (uint stride = 1u; stride < 256u; stride *= 2u) {
        uint lower = self >= stride ? sums[self - stride] : 0u;
        barrier();
        sums[self] += lower;
        barrier();
    }
    uint before = self > 0u ? sums[self - 1u] : 0u;
    for (uint bucket = first; bucket < first + run; ++bucket) {
        bucket_starts[bucket] = before;
        before += texelFetch(bucket_counts, int(bucket)).x;
    }
    if (self == 255u) {
        bucket_starts[push.bucket_count] = sums[255];
    }
}
