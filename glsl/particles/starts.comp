#version 460
#include "lib/prelude.glsl"

// One group turns counts into where each of `count` lists starts, the total behind them.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) writeonly buffer Starts { uint starts[]; };

layout(push_constant, scalar) uniform Push { uint count; } push;

#define SCAN_TYPE uint

uint scan_term(uint index) {
    return texelFetch(counts, int(index)).x;
}

void scan_store(uint index, uint before) {
    starts[index] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.count);
}
