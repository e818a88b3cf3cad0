// Sums of the mask over blocks of texels: level 0 is the mask itself, each further level sums 2x2 of the one before, up to a single block.
// The including shader declares `sampler2D mask` and `usamplerBuffer levels`, one texel a level: width · height · its first word among the
// sums · unused. `pyramid` holds the number of blocks of each level that are not empty, the number of the mask's texels that are no numbers, then the
// sums as bits of floats.
#ifndef PHOTONS_PYRAMID
#define PHOTONS_PYRAMID

#include "lib/finite.glsl"

const uint PYRAMID_DROPPED = 31u;
const uint PYRAMID_COUNTS = 32u;

struct Level {
    ivec2 size;
    uint first;
};

Level load_level(uint level) {
    uvec4 texel = texelFetch(levels, int(level));
    return Level(ivec2(texel.xy), texel.z);
}

uint place_of_block(Level level, ivec2 block) {
    return level.first + uint(block.y * level.size.x + block.x);
}

// Of a texel of the mask: nothing is drawn from what is no number.
float sound_flux(float flux) {
    return is_finite(flux) ? flux : 0.0;
}

bool holds(Level level, ivec2 block) {
    return all(lessThan(block, level.size));
}

#endif
