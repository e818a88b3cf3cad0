// Squares of 32x32 blocks of a level of the mask's pyramid, row by row: a bit a block, set where the block gets photons, sixteen parts of
// 8x8 of 64 bits each. They number the blocks, whatever the order in which groups run.
#ifndef PHOTONS_SQUARES
#define PHOTONS_SQUARES

const uint SQUARE_WORDS = 32u;

// Where bit `bit` of part `part` lies in the square.
uvec2 place_in_square(uint part, uint bit) {
    uint lane = bit & 7u;
    uint row = bit >> 3;
    uvec2 in_part = uvec2((row & 1u) * 4u + (lane & 3u), (row >> 1) * 2u + (lane >> 2));
    return 8u * uvec2(part & 3u, part >> 2) + in_part;
}

#endif
