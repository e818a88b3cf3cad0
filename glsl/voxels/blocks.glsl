// Blocks of 4³ voxels, of which it is known how far the next one is that holds anything: what cones skip by.
#ifndef VOXELS_BLOCKS
#define VOXELS_BLOCKS

const int BLOCK = 4;
// The longest distance that is told, in blocks.
const int FAR_BLOCK = 32;

ivec3 blocks_of(ivec3 dims) {
    return (dims + BLOCK - 1) / BLOCK;
}

#endif
