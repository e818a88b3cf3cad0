// What the device decides about a frame's photons, in words:
//
//   0 to 2   arguments of an indirect dispatch over the blocks of the chosen level, squares of 32x32 a group
//   3        the level
//   4        photons that each block of it gets at least
//   5        photons that are sent out
//   6        blocks that get photons
#ifndef PHOTONS_CHOICE
#define PHOTONS_CHOICE

const uint CHOICE_LEVEL = 3u;
const uint CHOICE_OF_BLOCK = 4u;
const uint CHOICE_PHOTONS = 5u;
const uint CHOICE_BLOCKS = 6u;

#endif
