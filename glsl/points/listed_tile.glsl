// One group of 64 works on one tile: one that is listed, or any. Eight consecutive invocations form 4×2 pixels, as in lib/pixels.glsl.
#ifndef POINTS_LISTED_TILE
#define POINTS_LISTED_TILE

#include "points/tiles.glsl"

// 1: there is no list, all tiles are filtered.
layout(constant_id = 1) const uint ALL_TILES = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer tile_head;
layout(set = 0, binding = 1) uniform usamplerBuffer tile_list;

const int NO_TILE = -1;

int tile_of_group(ivec2 size) {
    uint listed = gl_WorkGroupID.y * LISTED_A_ROW + gl_WorkGroupID.x;
    if (ALL_TILES != 0u) {
        ivec2 tiles = tiles_of(size);
        return int(listed) < tiles.x * tiles.y ? int(listed) : NO_TILE;
    }
    return listed < texelFetch(tile_head, 3).x ? int(texelFetch(tile_list, int(listed)).x) : NO_TILE;
}

ivec2 pixel_of_tile(int tile, ivec2 size) {
    uint lane = gl_LocalInvocationIndex & 7u;
    uint block = gl_LocalInvocationIndex >> 3;
    ivec2 in_tile = ivec2((block & 1u) * 4u + (lane & 3u), (block >> 1) * 2u + (lane >> 2));
    int columns = tiles_of(size).x;
    return TILE_SIDE * ivec2(tile % columns, tile / columns) + in_tile;
}

#endif
