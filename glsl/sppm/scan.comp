#version 460
#include "lib/prelude.glsl"

// One group turns the counts of the buckets into where each starts: bucket_starts[b] = Σ_{c<b} bucket_counts[c], the total at the end.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer bucket_counts;
layout(set = 0, binding = 1) writeonly buffer StartBlock { uint bucket_starts[]; };

layout(push_constant, scalar) uniform Push { uint bucket_count; } push;

#define SCAN_TYPE uint

uint scan_term(uint bucket) {
    return texelFetch(bucket_counts, int(bucket)).x;
}

void scan_store(uint bucket, uint before) {
    bucket_starts[bucket] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.bucket_count);
}
