#version 460
#include "lib/prelude.glsl"
#include "particles/facets.glsl"
#include "particles/widths.glsl"

// Lets the first cell of one triangle's side stand for all of it if particles are equally far apart in all of them (widths.glsl): they lie better on one sequence than on
// one of each cell.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer cells;
layout(set = 0, binding = 1) buffer Weights { uvec2 weights[]; };

layout(push_constant, scalar) uniform Push { uint triangle_count; } push;

void main() {
    uint index = gl_GlobalInvocationID.x / 2u;
    uint side = gl_GlobalInvocationID.x % 2u;
    if (index >= push.triangle_count) {
        return;
    }
    uvec2 record = texelFetch(cells, int(index)).xy;
    Cuts cuts = unpack_cuts(record.y);
    uint count = cuts.columns * cuts.rows;
    if (count == 0u || side >= cuts.sides) {
        return;
    }
    uint first = record.x + side * count;
    uint width = weights[first].y;
    bool same = true;
    float area = 0.0;
    [[dont_unroll]] for (uint cell = first; cell < first + count && same; ++cell) {
        same = weights[cell].y == width;
        area += uintBitsToFloat(weights[cell].x);
    }
    if (!same) {
        return;
    }
    [[dont_unroll]] for (uint cell = first; cell < first + count; ++cell) {
        weights[cell].x = 0u;
    }
    weights[first] = uvec2(floatBitsToUint(area), width | WHOLE_SIDE);
}
