#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "photon_splat/levels.glsl"

// One group turns the counts of a row of cells into where each cell's photons start in the sorted list. Rows stand in it in any order, the
// cells of a row side by side, so that a stretch of a row is one run of photons.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer cell_counts;
layout(set = 0, binding = 1) writeonly buffer StartBlock { uint cell_starts[]; };
layout(set = 0, binding = 2) buffer SortedBlock { uint sorted_count[]; };

layout(push_constant, scalar) uniform Push { uint row_count; } push;

shared uint row_start;
int first_cell;  // of the row

#define SCAN_TYPE uint

uint scan_term(uint cell) {
    return texelFetch(cell_counts, first_cell + int(cell)).x;
}

void scan_store(uint cell, uint before) {
    cell_starts[first_cell + int(cell)] = before;
}

#include "lib/prefix_scan.glsl"

void scan_row(int row) {
    int level = 0;
    uvec4 cells = texelFetch(splat_levels, 0);
    int level_count = textureSize(splat_levels);
    while (row >= int(cells.y) && level + 1 < level_count) {
        row -= int(cells.y);
        ++level;
        cells = texelFetch(splat_levels, level);
    }
    first_cell = cell_index(ivec2(0, row), cells);
    uint before = scan_sum_before_run(cells.x);
    if (gl_LocalInvocationIndex == 0u) {
        uint total = scan_total();
        row_start = total > 0u ? atomicAdd(sorted_count[0], total) : 0u;
        scan_store(cells.x, row_start + total);
    }
    barrier();
    scan_store_run(cells.x, row_start + before);
    barrier();
}

void main() {
    for (uint row = gl_WorkGroupID.x; row < push.row_count; row += gl_NumWorkGroups.x) {
        scan_row(int(row));
    }
}
