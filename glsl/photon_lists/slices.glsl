// Which depths of a block of texels hold a surface: the way from 0 to the view's far depth in 128 slices, a bit each. The paper skips what lies
// outside the depths between a texel's first and last surface; in a closed room seen from outside that is nothing, since the first is the
// ceiling and the last the floor. Slices tell the empty room between them.
#ifndef PHOTON_LISTS_SLICES
#define PHOTON_LISTS_SLICES

const float SLICES = 128.0;

// A block of level l covers 4^l × 4^l texels; level 0, single texels, is the lists themselves.
const uint LEVEL_BITS = 2u;

uint blocks_of_level(uint resolution, uint level) {
    return (resolution + (1u << LEVEL_BITS * level) - 1u) >> LEVEL_BITS * level;
}

// The bits below `slice`.
uvec4 slices_below(int slice) {
    ivec4 bits = clamp(slice - ivec4(0, 32, 64, 96), 0, 32);
    uvec4 some = (uvec4(1u) << uvec4(bits & 31)) - 1u;
    return mix(some, uvec4(0xFFFFFFFFu), equal(bits, ivec4(32)));
}

// The slices that the depths from `low` to `high`, in units of slices, touch.
uvec4 slices_between(float low, float high) {
    return slices_below(int(clamp(high, -1.0, SLICES)) + 1) & ~slices_below(int(clamp(low, 0.0, SLICES)));
}

#endif
