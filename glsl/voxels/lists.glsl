// What glsl/voxels/triangles.comp leaves: numbers of triangles and tiles, and how many groups their passes run.
#ifndef VOXELS_LISTS
#define VOXELS_LISTS

// Words 0 to 3 are the arguments of a draw of as many points as there are triangles.
const uint COUNT_TRIANGLES = 0u;
const uint COUNT_TILES = 4u;
const uint GROUPS_OF_TILES = 5u;        // three words
const uint COUNT_SOLID_TILES = 8u;
const uint GROUPS_OF_SOLID_TILES = 9u;  // three words
const uint COUNT_WORDS = 12u;

// Columns along a side of a tile: what one invocation works off of a triangle.
const int TILE = 8;

// Groups that every device runs in a row, and invocations of one.
const uint MOST_GROUPS = 65535u;
const uint TILE_GROUP = 64u;

// A tile: the number of its triangle, and its place in the plane that the triangle is seen in.
ivec2 place_of_tile(uvec2 tile) {
    return ivec2(tile.y & 0xFFFFu, tile.y >> 16);
}

#endif
