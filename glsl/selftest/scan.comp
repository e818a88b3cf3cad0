#version 460
#include "lib/prelude.glsl"

// The sums before each of some numbers, and the sum of all behind them.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer Numbers { uint numbers[]; };
layout(set = 0, binding = 1) writeonly buffer SumsBefore { uint sums_before[]; };

layout(push_constant, scalar) uniform Push { uint number_count; } push;

#define SCAN_TYPE uint

uint scan_term(uint index) {
    return numbers[index];
}

void scan_store(uint index, uint before) {
    sums_before[index] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.number_count);
}
