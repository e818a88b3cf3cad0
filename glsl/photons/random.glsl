// Numbers that decide a photon's way. Photons are numbered along Morton's curve over the light views' atlas, so that those of a square of 2ᵐ
// by 2ᵐ blocks are 4ᵐ consecutive points of a (0,2)-sequence (Sobol' 1967, Owen-scrambled): neighbours in the view send rays to different
// parts of their lobes, and the same ones in every frame (Ahmed & Wonka 2020).
#ifndef PHOTONS_RANDOM
#define PHOTONS_RANDOM

#include "lib/sobol.glsl"

// Puts a zero between the lowest 16 bits.
uint spread_bits(uint x) {
    x &= 0xFFFFu;
    x = (x | x << 8) & 0x00FF00FFu;
    x = (x | x << 4) & 0x0F0F0F0Fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

uint morton_code(uvec2 place) {
    return spread_bits(place.x) | spread_bits(place.y) << 1;
}

// The second dimension's generator is Pascal's triangle modulo 2, the 32-fold product of which takes five steps. Bits reversed.
uint sobol_second_reversed(uint index) {
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0F0F0F0Fu;
    index ^= index >> 8 & 0x00FF00FFu;
    return index ^ (index >> 16);
}

// Point `index` of the set that `seed` names, in [0, 1)². An Owen scrambling of the index keeps aligned runs of 4ᵐ together.
vec2 stratified_pair(uint index, uint seed) {
    uint shuffled = bitfieldReverse(scramble_reversed(bitfieldReverse(index), seed));
    uvec2 scrambled = uvec2(
        scramble_reversed(shuffled, seed_of(seed, 1u)), scramble_reversed(sobol_second_reversed(shuffled), seed_of(seed, 2u)));
    return vec2(bitfieldReverse(scrambled) >> 8) * (1.0 / 16777216.0);
}

// Four numbers of photon `index` at its event number `stream`.
vec4 photon_random(uint index, uint stream) {
    return vec4(stratified_pair(index, seed_of(0x51ED270Bu, stream)), stratified_pair(index, seed_of(0xB5297A4Du, stream)));
}

#endif
