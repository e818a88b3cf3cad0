#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "photon_splat/levels.glsl"

// One group turns the counts of a row of cells into where each cell's photons start in the sorted list. Rows stand in it in any order, the
// cells of a row side by side, so that a stretch of a row is one run of photons. Each invocation sums a run of cells, the group
// scans the 64 sums (Hillis & Steele 1986), each invocation walks its run again.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer cell_counts;
layout(set = 0, binding = 1) writeonly buffer StartBlock { uint cell_starts[]; };
layout(set = 0, binding = 2) buffer SortedBlock { uint sorted_count[]; };

layout(push_constant, scalar) uniform Push { uint row_count; } push;

shared uint sums[64];
shared uint row_start;

void scan_row(int row) {
    int level = 0;
    uvec4 cells = texelFetch(splat_levels, 0);
    while (row >= int(cells.y)) {
        row -= int(cells.y);
        ++level;
        cells = texelFetch(splat_levels, level);
    }
    int self = int(gl_LocalInvocationIndex);
    int run = (int(cells.x) + 63) / 64;
    int base = cell_index(ivec2(0, row), cells);
    int first = base + min(self * run, int(cells.x));
    int end = base + min((self + 1) * run, int(cells.x));
    uint sum = 0u;
    for (int cell = first; cell < end; ++cell) {
        sum += texelFetch(cell_counts, cell).x;
    }
    sums[self] = sum;
    barrier();
    [[dont_unroll]] for (int stride = 1; stride < 64; stride *= 2) {
        uint lower = self >= stride ? sums[self - stride] : 0u;
        barrier();
        sums[self] += lower;
        barrier();
    }
    if (self == 63) {
        row_start = sums[63] > 0u ? atomicAdd(sorted_count[0], sums[63]) : 0u;
    }
    barrier();
    uint before = row_start + (self > 0 ? sums[self - 1] : 0u);
    for (int cell = first; cell < end; ++cell) {
        cell_starts[cell] = before;
        before += texelFetch(cell_counts, cell).x;
    }
    if (self == 63) {
        cell_starts[base + int(cells.x)] = row_start + sums[63];
    }
    barrier();
}

void main() {
    for (uint row = gl_WorkGroupID.x; row < push.row_count; row += gl_NumWorkGroups.x) {
        scan_row(int(row));
    }
}
