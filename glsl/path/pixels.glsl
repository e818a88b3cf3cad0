// Which pixel a path belongs to. A wave holds `sample_count` samples of a run of blocks of 8x8 pixels; a path's number is
// sample · 64 · block_count + 64 · block + place, with 4x2 pixels to eight consecutive places (see lib/pixels.glsl).
#ifndef PATH_PIXELS
#define PATH_PIXELS

struct WavePixels {
    uvec2 size;          // of the image
    uint first_block;    // in rows of blocks
    uint block_count;
};

uvec2 pixel_of_place(WavePixels wave, uint place_in_wave) {
    uint block = wave.first_block + place_in_wave / 64u;
    uint place = place_in_wave & 63u;
    uint lane = place & 7u;
    uint part = place >> 3;
    uvec2 in_block = uvec2((part & 1u) * 4u + (lane & 3u), (part >> 1) * 2u + (lane >> 2));
    uint blocks_per_row = (wave.size.x + 7u) / 8u;
    return uvec2(block % blocks_per_row, block / blocks_per_row) * 8u + in_block;
}

#endif
