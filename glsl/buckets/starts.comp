#version 460
#include "lib/prelude.glsl"

// One group turns the counts of buckets into where each starts: starts[b] = Σ_{c<b} counts[c], the total at the end.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) writeonly buffer Starts { uint starts[]; };

layout(push_constant, scalar) uniform Push { uint bucket_count; } push;

#define SCAN_TYPE uint

uint scan_term(uint bucket) {
    return texelFetch(counts, int(bucket)).x;
}

void scan_store(uint bucket, uint before) {
    starts[bucket] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.bucket_count);
}
