// The voxels of one column along a triangle's dominant axis that the triangle touches. Compute and raster variant propose columns, this decides: so both
// give the same bits. The including shader has `bits`, one for each voxel.
#ifndef VOXELS_COLUMN
#define VOXELS_COLUMN

#include "voxels/overlap.glsl"

// `triangle`, `normal`, `column` and the voxels that its box covers, `first` to `last`, are turned so that the dominant axis is the third.
void mark_column(VoxelTriangle triangle, ivec3 normal, int axis, ivec2 column, ivec3 first, ivec3 last, VoxelGrid grid) {
    int size = grid.units;
    ivec2 low = column * size;
    if (any(lessThan(column, first.xy)) || any(greaterThan(column, last.xy))
        || !within_edges(triangle.a.xy, triangle.b.xy, triangle.c.xy, normal.z, low, size)) {
        return;
    }
    // Where the plane crosses the column, and a unit for the rounding of that. A triangle without area has no plane.
    int from = first.z;
    int to = last.z;
    if (normal.z != 0) {
        vec2 slope = -vec2(normal.xy) / float(normal.z);
        vec2 half_way = float(size) * vec2(0.5);
        float middle = float(triangle.a.z) + dot(slope, vec2(low - triangle.a.xy) + half_way);
        float reach = dot(abs(slope), half_way) + 1.0;
        from = max(from, int(floor((middle - reach) / float(size))));
        to = min(to, int(floor((middle + reach) / float(size))));
    }
    for (int place = from; place <= to; ++place) {
        if (touches(triangle, normal, ivec3(low, place * size), size)) {
            uint voxel = voxel_number(turned_back(ivec3(column, place), axis), grid.dims);
            atomicOr(bits[voxel >> 5], 1u << (voxel & 31u));
        }
    }
}

#endif
