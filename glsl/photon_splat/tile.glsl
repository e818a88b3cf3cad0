// Tiles of 8×8 samples, in rows; those of its samples in the order of a group's invocations: eight form 4×2 samples, as in lib/pixels.glsl.
#ifndef PHOTON_SPLAT_TILE
#define PHOTON_SPLAT_TILE

const int TILE_SIDE = 8;

int tiles_a_row(ivec2 size) {
    return (size.x + TILE_SIDE - 1) / TILE_SIDE;
}

uint invocation_of_sample(ivec2 place) {
    uvec2 inside = uvec2(place) & 7u;
    return (inside.y >> 1) << 4 | (inside.x >> 2) << 3 | (inside.y & 1u) << 2 | (inside.x & 3u);
}

ivec2 sample_of_invocation(uint invocation) {
    uint lane = invocation & 7u;
    uint block = invocation >> 3;
    return ivec2((block & 1u) * 4u + (lane & 3u), (block >> 1) * 2u + (lane >> 2));
}

#endif
