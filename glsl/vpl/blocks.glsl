// Blocks of 8x8 texels of the light views' atlas: what virtual point lights are shared out by.
#ifndef VPL_BLOCKS
#define VPL_BLOCKS

const int BLOCK_SIDE = 8;
const uint BLOCKS_PER_TILE = 4u;

// What a view gets of the VPLs.
struct ViewShare {
    vec3 extra;   // flux of views that are too dark for a VPL of their own, W: this view's carry it together
    uint first;   // VPL
    uint count;
};

#endif
