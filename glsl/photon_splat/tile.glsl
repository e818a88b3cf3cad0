// Tiles of 16×16 samples, in rows. A group of 64 takes a tile; eight consecutive invocations form 4×2 samples, as in lib/pixels.glsl, and each has
// four samples, 0 … 3, so that the eight have a block of 8×4.
#ifndef PHOTON_SPLAT_TILE
#define PHOTON_SPLAT_TILE

const int TILE_SIDE = 16;
const int TILE_SAMPLES = TILE_SIDE * TILE_SIDE;
const ivec2 BLOCK = ivec2(8, 4);

int tiles_a_row(ivec2 size) {
    return (size.x + TILE_SIDE - 1) / TILE_SIDE;
}

ivec2 sample_of_invocation(uint invocation, int which) {
    uint lane = invocation & 7u;
    uint block = invocation >> 3;
    ivec2 in_block = ivec2(lane & 3u, lane >> 2) + ivec2(4 * (which & 1), 2 * (which >> 1));
    return BLOCK * ivec2(block & 1u, block >> 1) + in_block;
}

// Where a tile's sample stands in lists of all its samples.
int index_in_tile(uint invocation, int which) {
    return 64 * which + int(invocation);
}

// The same from the sample's place on the image.
int index_in_tile(ivec2 place) {
    ivec2 inside = place & (TILE_SIDE - 1);
    int invocation = (inside.y >> 2) << 4 | (inside.x >> 3) << 3 | (inside.y & 1) << 2 | (inside.x & 3);
    return index_in_tile(uint(invocation), (inside.y >> 1 & 1) << 1 | (inside.x >> 2 & 1));
}

#endif
