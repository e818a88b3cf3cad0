// One group of 64 works on one tile out of the list of those that photons reach (touch.comp).
#ifndef PHOTON_SPLAT_LISTED_TILE
#define PHOTON_SPLAT_LISTED_TILE

#include "photon_splat/state.glsl"
#include "photon_splat/tile.glsl"

const int NO_TILE = -1;

// `list`: STATE_TILES or STATE_CROWDED.
int listed_tile(usamplerBuffer state, usamplerBuffer tiles, uint list, uint row) {
    uint listed = row * LISTED_A_ROW + gl_WorkGroupID.x;
    return listed < texelFetch(state, int(list + 3u)).x ? int(texelFetch(tiles, int(listed)).x) : NO_TILE;
}

int listed_tile(usamplerBuffer state, usamplerBuffer tiles, uint list) {
    return listed_tile(state, tiles, list, gl_WorkGroupID.y);
}

// Sums are kept for a range of tiles at a time: the first, and the one after the last.
int tile_in_range(int tile, ivec2 range) {
    return tile >= range.x && tile < range.y ? tile : NO_TILE;
}

ivec2 sample_of_tile(int tile, ivec2 size, int which) {
    int columns = tiles_a_row(size);
    return TILE_SIDE * ivec2(tile % columns, tile / columns) + sample_of_invocation(gl_LocalInvocationIndex, which);
}

#endif
