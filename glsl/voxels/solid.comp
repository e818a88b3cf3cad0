#version 460
#include "lib/prelude.glsl"
#include "voxels/lists.glsl"
#include "voxels/overlap.glsl"

// Where rows of voxels' centres along x cross the triangles of closed meshes, within one tile: a step of the winding number at the first centre behind it,
// +1 into the solid, −1 out of it. Schwarz & Seidel 2010, section 4, flip all bits behind a crossing; a winding number knows outside from inside where solids
// overlap, and finds none in a shell whose front looks inwards.
//
// A centre on the edge of two triangles belongs to one of them.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) uniform usamplerBuffer triangles;
layout(set = 0, binding = 2) uniform usamplerBuffer solid_tiles;
layout(set = 0, binding = 3) buffer CrossingBlock { uint crossings[]; };  // four voxels a word, of 8 bits with their sign

layout(push_constant, scalar) uniform Push {
    VoxelGrid grid;
    uint triangle_capacity;
    uint tile_capacity;
} push;

// Whether a point lies on the inner side of an edge, or on it and the edge is one of the two directions that own their points.
bool has_inside(ivec2 a, ivec2 b, int turn, ivec2 point) {
    ivec2 edge = turn * (b - a);
    ivec2 way = point - a;
    int side = edge.x * way.y - edge.y * way.x;
    return side > 0 || (side == 0 && (edge.y < 0 || (edge.y == 0 && edge.x > 0)));
}

void cross_row(VoxelTriangle triangle, ivec3 normal, ivec2 column) {
    int size = push.grid.units;
    ivec2 center = column * size + size / 2;
    int turn = normal.z < 0 ? -1 : 1;
    if (!has_inside(triangle.a.xy, triangle.b.xy, turn, center) || !has_inside(triangle.b.xy, triangle.c.xy, turn, center)
        || !has_inside(triangle.c.xy, triangle.a.xy, turn, center)) {
        return;
    }
    vec2 slope = -vec2(normal.xy) / float(normal.z);
    float depth = float(triangle.a.z) + dot(slope, vec2(center - triangle.a.xy));
    int voxel = max(int(ceil(depth / float(size) - 0.5)), 0);
    if (voxel < push.grid.dims.x) {
        bool enters = (normal.z < 0) != triangle.flipped;
        uint number = voxel_number(ivec3(voxel, column), push.grid.dims);
        atomicAdd(crossings[number >> 2], (enters ? 1u : 0xFFFFFFFFu) << (8u * (number & 3u)));
    }
}

void main() {
    uint count = min(texelFetch(counts, int(COUNT_SOLID_TILES)).x, push.tile_capacity);
    uint step = gl_NumWorkGroups.x * TILE_GROUP;
    for (uint number = gl_GlobalInvocationID.x; number < count; number += step) {
        uvec2 tile = texelFetch(solid_tiles, int(number)).xy;
        if (tile.x < push.triangle_capacity) {
            int record = 2 * int(tile.x);
            VoxelTriangle triangle = unpacked_triangle(texelFetch(triangles, record), texelFetch(triangles, record + 1));
            triangle = turned_triangle(triangle, 0);
            ivec3 normal = normal_of(triangle);
            ivec2 from = max(place_of_tile(tile) * TILE, lowest(triangle).xy / push.grid.units);
            ivec2 to = min(place_of_tile(tile) * TILE + TILE - 1, highest(triangle).xy / push.grid.units);
            for (int row = from.y; row <= to.y; ++row) {
                for (int column = from.x; column <= to.x; ++column) {
                    cross_row(triangle, normal, ivec2(column, row));
                }
            }
        }
    }
}
