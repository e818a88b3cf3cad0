// Hilbert's curve through a square of 16x16 texels: consecutive indices are neighbours. Squares that lie along a larger
// curve continue it when each is turned as its orientation says (src/frame/view_layout.rs): then all texels of a view
// form one path without a jump, and a small change of an index is a small change of place.
#ifndef LIB_HILBERT
#define LIB_HILBERT

const uint HILBERT_TRANSPOSED = 1u;
const uint HILBERT_TURNED = 2u;  // by half a turn

ivec2 hilbert_decode(uint index, uint orientation) {
    uvec2 cell = uvec2(0u);
    uint rest = index;
    [[dont_unroll]] for (uint side = 1u; side < 16u; side *= 2u) {
        uint right = (rest >> 1) & 1u;
        uint below = (rest ^ right) & 1u;
        if (below == 0u) {
            cell = right == 1u ? side - 1u - cell : cell;
            cell = cell.yx;
        }
        cell += side * uvec2(right, below);
        rest >>= 2;
    }
    cell = (orientation & HILBERT_TURNED) != 0u ? 15u - cell : cell;
    return ivec2((orientation & HILBERT_TRANSPOSED) != 0u ? cell.yx : cell);
}

#endif
