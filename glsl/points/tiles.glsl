// Tiles of 8×8 pixels, row by row, and the list of those that photons reach.
//
//   tile_reaches   by tile: 0, or 1 more than the pixels that light is spread over at most, of all photons that reach the tile
//   tile_lit       two words a tile: a bit for each pixel on which photons fall, row by row
//   tile_head      arguments of a dispatch of a group a tile, LISTED_A_ROW at most along x (3) · how many tiles are listed
#ifndef POINTS_TILES
#define POINTS_TILES

const int TILE_SIDE = 8;
const uint LISTED_A_ROW = 32768u;

ivec2 tiles_of(ivec2 size) {
    return (size + TILE_SIDE - 1) / TILE_SIDE;
}

int tile_of_pixel(ivec2 pixel, ivec2 size) {
    ivec2 tile = pixel / TILE_SIDE;
    return tile.y * tiles_of(size).x + tile.x;
}

int bit_in_tile(ivec2 pixel) {
    ivec2 inside = pixel & (TILE_SIDE - 1);
    return TILE_SIDE * inside.y + inside.x;
}

#endif
