#version 460
#include "lib/prelude.glsl"
#include "particles/widths.glsl"

// One group sums the weighted areas before each cell, the total behind them, and from it the spacing √(A/N) of N particles where they lie closest, with the levels
// that their grid has.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer weights;
layout(set = 0, binding = 1) uniform usamplerBuffer cells;
layout(set = 0, binding = 2) writeonly buffer Sums { float sums[]; };
layout(set = 0, binding = 3) writeonly buffer Spacing { float spacing[]; };  // m
layout(set = 0, binding = 4) writeonly buffer Levels { uint levels[]; };

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint particle_count;
} push;

shared uint widest;

#define SCAN_TYPE float

float scan_term(uint index) {
    return uintBitsToFloat(texelFetch(weights, int(index)).x);
}

void scan_store(uint index, float before) {
    sums[index] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    uint cell_count = texelFetch(cells, int(push.triangle_count)).x;
    if (gl_LocalInvocationIndex == 0u) {
        widest = 0u;
    }
    barrier();
    uint own = 0u;
    [[dont_unroll]] for (uint cell = gl_LocalInvocationIndex; cell < cell_count; cell += gl_WorkGroupSize.x) {
        own = max(own, texelFetch(weights, int(cell)).y & ~WHOLE_SIDE);
    }
    atomicMax(widest, own);
    scan(cell_count);
    if (gl_LocalInvocationIndex == 0u) {
        spacing[0] = sqrt(max(scan_total() / float(push.particle_count), 1e-30));
        levels[0] = level_of_width(widest) + 1u;
    }
}
