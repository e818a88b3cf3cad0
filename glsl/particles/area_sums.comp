#version 460
#include "lib/prelude.glsl"
#include "particles/cells.glsl"

// One group sums the weighted areas before each cell, the total behind them, and from it the spacing √(A/N) of N particles where weights are 1: the widest there is.

layout(local_size_x = 256) in;

// 0: cells are triangles, and weigh 1.
layout(constant_id = 0) const uint ADAPTIVE = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer areas;
layout(set = 0, binding = 1) uniform usamplerBuffer weighted;
layout(set = 0, binding = 2) writeonly buffer Cells { uvec4 cells[]; };
layout(set = 0, binding = 3) writeonly buffer Spacing { float spacing[]; };

layout(push_constant, scalar) uniform Push {
    uint cell_count;
    uint particle_count;
} push;

#define SCAN_TYPE float

float scan_term(uint index) {
    return ADAPTIVE != 0u ? uintBitsToFloat(texelFetch(weighted, int(index)).x) : texelFetch(areas, int(index)).x;
}

void scan_store(uint index, float before) {
    uvec4 cell = cell_record(0.0, index, 0u, 1u, INVERSE_WEIGHT_STEPS);
    if (ADAPTIVE != 0u) {
        cell = texelFetch(weighted, int(min(index, push.cell_count - 1u)));
    }
    cells[index] = uvec4(floatBitsToUint(before), cell.yzw);
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.cell_count);
    if (gl_LocalInvocationIndex == 0u) {
        spacing[0] = sqrt(max(scan_total() / float(push.particle_count), 1e-30));
    }
}
