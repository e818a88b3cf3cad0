#version 460
#include "lib/prelude.glsl"

// One group turns the areas of blocks of triangles into sums before each: area_before[b] = Σ_{s<b} block_areas[s], the scene's area [m²]
// at the end. Each invocation sums a run of consecutive blocks, the group scans the 256 sums (Hillis & Steele 1986), each invocation walks its
// run again. Fixed order: the same bits every time.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) readonly buffer BlockAreas { float block_areas[]; };
layout(set = 0, binding = 1) writeonly buffer AreaBefore { float area_before[]; };

layout(push_constant, scalar) uniform Push { uint block_count; } push;

shared float sums[256];

void main() {
    uint self = gl_LocalInvocationIndex;
    uint run = (push.block_count + 255u) / 256u;
    uint first = min(self * run, push.block_count);
    uint end = min(first + run, push.block_count);

    float sum = 0.0;
    for (uint block = first; block < end; ++block) {
        sum += block_areas[block];
    }
    sums[self] = sum;
    barrier();
    [[dont_unroll]] for (uint stride = 1u; stride < 256u; stride *= 2u) {
        float lower = self >= stride ? sums[self - stride] : 0.0;
        barrier();
        sums[self] += lower;
        barrier();
    }

    float before = self > 0u ? sums[self - 1u] : 0.0;
    for (uint block = first; block < end; ++block) {
        area_before[block] = before;
        before += block_areas[block];
    }
    if (self == 255u) {
        area_before[push.block_count] = sums[255];
    }
}
