#version 460
#include "lib/prelude.glsl"
#include "voxels/lists.glsl"
#include "voxels/triangle.glsl"

// The voxels that a triangle touches within one tile of columns along its dominant axis (Schwarz & Seidel 2010, without their rounding).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) uniform usamplerBuffer triangles;
layout(set = 0, binding = 2) uniform usamplerBuffer tiles;
layout(set = 0, binding = 3) buffer BitBlock { uint bits[]; };

layout(push_constant, scalar) uniform Push {
    VoxelGrid grid;
    uint triangle_capacity;
    uint tile_capacity;
} push;

#include "voxels/column.glsl"

void fill(uvec2 tile) {
    int record = 2 * int(tile.x);
    VoxelTriangle triangle = unpacked_triangle(texelFetch(triangles, record), texelFetch(triangles, record + 1));
    int axis = dominant_axis(normal_of(triangle));
    triangle = turned_triangle(triangle, axis);
    ivec3 normal = normal_of(triangle);
    ivec3 first = lowest(triangle) / push.grid.units;
    ivec3 last = highest(triangle) / push.grid.units;
    ivec2 from = max(place_of_tile(tile) * TILE, first.xy);
    ivec2 to = min(place_of_tile(tile) * TILE + TILE - 1, last.xy);
    for (int row = from.y; row <= to.y; ++row) {
        for (int column = from.x; column <= to.x; ++column) {
            mark_column(triangle, normal, axis, ivec2(column, row), first, last, push.grid);
        }
    }
}

void main() {
    uint count = min(texelFetch(counts, int(COUNT_TILES)).x, push.tile_capacity);
    uint step = gl_NumWorkGroups.x * TILE_GROUP;
    for (uint number = gl_GlobalInvocationID.x; number < count; number += step) {
        uvec2 tile = texelFetch(tiles, int(number)).xy;
        if (tile.x < push.triangle_capacity) {
            fill(tile);
        }
    }
}
