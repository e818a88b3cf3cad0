#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "lib/finite.glsl"
#include "voxels/lists.glsl"
#include "voxels/overlap.glsl"

// One triangle of the scene in units of the grid, cut at the grid's borders, and the tiles of columns that it is worked off in: so a triangle that
// covers the whole grid is shared by as many invocations as a thousand small ones.
//
// A group takes one chunk: up to 64 triangles of one instance.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint LISTS_TILES = 1u;  // 0: the triangles are drawn
layout(constant_id = 1) const uint LISTS_SOLID_TILES = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer chunks;  // instance · first triangle in it · number of triangles · whether it is solid
layout(set = 0, binding = 1) buffer CountBlock { uint counts[]; };
layout(set = 0, binding = 2) writeonly buffer TriangleBlock { PackedTriangle triangles[]; };
layout(set = 0, binding = 3) writeonly buffer TileBlock { uvec2 tiles[]; };
layout(set = 0, binding = 4) writeonly buffer SolidTileBlock { uvec2 solid_tiles[]; };

layout(push_constant, scalar) uniform Push {
    VoxelGrid grid;
    uint chunk_count;
    uint triangle_capacity;
    uint tile_capacity;
    uint solid_tile_capacity;
} push;

// Corners of a triangle that is cut by six planes.
const int MOST_CORNERS = 9;

vec3 in_units(mat3x4 transform, int vertex) {
    int first = 3 * vertex;
    vec3 place = vec3(texelFetch(positions, first).x, texelFetch(positions, first + 1).x, texelFetch(positions, first + 2).x);
    return (vec4(place, 1.0) * transform - push.grid.origin_rs) * (float(push.grid.units) / push.grid.size);
}

ivec3 rounded(vec3 place) {
    return clamp(2 * ivec3(floor(0.5 * place)) + 1, ivec3(1), push.grid.dims * push.grid.units - 1);
}

// Keeps what lies on one side of a plane across `axis` (Sutherland & Hodgman 1974).
void cut(inout vec3 corners[MOST_CORNERS], inout int count, vec3 axis, float border, float side) {
    vec3 kept[MOST_CORNERS];
    int kept_count = 0;
    [[dont_unroll]] for (int corner = 0; corner < count; ++corner) {
        vec3 from = corners[corner];
        vec3 to = corners[corner + 1 < count ? corner + 1 : 0];
        float inside = side * (dot(axis, from) - border);
        float inside_next = side * (dot(axis, to) - border);
        if (inside >= 0.0 && kept_count < MOST_CORNERS) {
            kept[kept_count++] = from;
        }
        if ((inside >= 0.0) != (inside_next >= 0.0) && kept_count < MOST_CORNERS) {
            kept[kept_count++] = mix(from, to, inside / (inside - inside_next));
        }
    }
    [[dont_unroll]] for (int corner = 0; corner < kept_count; ++corner) {
        corners[corner] = kept[corner];
    }
    count = kept_count;
}

// The tiles of a triangle in the plane across `axis` that it touches: their number, or, with a place in the list, that they are stored.
uint tiles_of(VoxelTriangle triangle, int axis, uint number, bool solid, bool store, uint place) {
    VoxelTriangle seen = turned_triangle(triangle, axis);
    ivec2 a = seen.a.xy;
    ivec2 b = seen.b.xy;
    ivec2 c = seen.c.xy;
    int area = normal_of(seen).z;
    int size = TILE * push.grid.units;
    ivec2 first = lowest(seen).xy / size;
    ivec2 last = highest(seen).xy / size;
    bool is_only_one = first == last;
    uint count = 0u;
    for (int row = first.y; row <= last.y; ++row) {
        for (int column = first.x; column <= last.x; ++column) {
            if (is_only_one || within_edges(a, b, c, area, ivec2(column, row) * size, size)) {
                uint at = place + count;
                uvec2 tile = uvec2(number, uint(column) | uint(row) << 16);
                if (store && !solid && at < push.tile_capacity) {
                    tiles[at] = tile;
                }
                if (store && solid && at < push.solid_tile_capacity) {
                    solid_tiles[at] = tile;
                }
                ++count;
            }
        }
    }
    return count;
}

void list_tiles(VoxelTriangle triangle, int axis, uint number, bool solid) {
    uint count = tiles_of(triangle, axis, number, solid, false, 0u);
    if (count > 0u) {
        uint place = atomicAdd(counts[solid ? COUNT_SOLID_TILES : COUNT_TILES], count);
        uint groups = min((place + count + TILE_GROUP - 1u) / TILE_GROUP, MOST_GROUPS);
        atomicMax(counts[solid ? GROUPS_OF_SOLID_TILES : GROUPS_OF_TILES], groups);
        tiles_of(triangle, axis, number, solid, true, place);
    }
}

void add(VoxelTriangle triangle, bool solid) {
    uint number = atomicAdd(counts[COUNT_TRIANGLES], 1u);
    if (number < push.triangle_capacity) {
        triangles[number] = packed_triangle(triangle);
    }
    ivec3 normal = normal_of(triangle);
    if (LISTS_TILES != 0u) {
        list_tiles(triangle, dominant_axis(normal), number, false);
    }
    // Seen along x, where one that is seen edge-on is nothing.
    if (LISTS_SOLID_TILES != 0u && solid && normal.x != 0) {
        list_tiles(triangle, 0, number, true);
    }
}

void main() {
    uint chunk_number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (chunk_number >= push.chunk_count) {
        return;
    }
    uvec4 chunk = texelFetch(chunks, int(chunk_number));
    if (gl_LocalInvocationIndex >= chunk.z) {
        return;
    }
    Instance instance = load_instance(instances, chunk.x);
    bool flipped = (instance.flags & INSTANCE_FLIPPED) != 0u;
    int index = int(instance.first_index + 3u * (chunk.y + gl_LocalInvocationIndex));
    vec3 corners[MOST_CORNERS];
    [[dont_unroll]] for (int corner = 0; corner < 3; ++corner) {
        int vertex = int(texelFetch(indices, index + corner).x) + instance.vertex_offset;
        corners[corner] = in_units(instance.object_to_render, vertex);
    }
    vec3 low = min(corners[0], min(corners[1], corners[2]));
    vec3 high = max(corners[0], max(corners[1], corners[2]));
    vec3 border = vec3(push.grid.dims * push.grid.units);
    if (!is_finite(vec4(low, 0.0)) || !is_finite(vec4(high, 0.0)) || any(lessThan(high, vec3(0.0))) || any(greaterThan(low, border))) {
        return;
    }
    int count = 3;
    if (any(lessThan(low, vec3(0.0))) || any(greaterThan(high, border))) {
        [[dont_unroll]] for (int plane = 0; plane < 6; ++plane) {
            int along = plane >> 1;
            vec3 axis = vec3(along == 0, along == 1, along == 2);
            bool upper = (plane & 1) != 0;
            cut(corners, count, axis, upper ? dot(axis, border) : 0.0, upper ? -1.0 : 1.0);
        }
    }
    ivec3 start = rounded(corners[0]);
    [[dont_unroll]] for (int corner = 2; corner < count; ++corner) {
        add(VoxelTriangle(start, rounded(corners[corner - 1]), rounded(corners[corner]), flipped), chunk.w != 0u);
    }
}
