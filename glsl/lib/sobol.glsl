// Owen-scrambled Sobol' points: Burley 2020, "Practical Hash-based Owen Scrambling" (JCGT 9(4)), with the hash of Vegdahl 2021.
//
// The host uploads the first 4096 points of the four-dimensional sequence, bits reversed. Higher dimensions are further sets of four,
// each in an order and with a scrambling of its own (padding). Samples beyond 4096 start over with another seed.
#ifndef LIB_SOBOL
#define LIB_SOBOL

const uint SOBOL_POINTS = 4096u;

// A good 32-bit mix (Wellons's lowbias32).
uint mix_bits(uint x) {
    x ^= x >> 16;
    x *= 0x7FEB352Du;
    x ^= x >> 15;
    x *= 0x846CA68Bu;
    return x ^ (x >> 16);
}

uint seed_of(uint seed, uint stream) {
    return mix_bits(seed ^ (stream * 0x9E3779B9u + 0x85EBCA6Bu));
}

// The sequence of samples of a pixel: the same in every frame.
uint seed_of_pixel(ivec2 pixel) {
    return mix_bits(uint(pixel.y) << 16 | uint(pixel.x));
}

// Permutes numbers whose bits are reversed so that each bit depends on those below it alone: an Owen scrambling.
uint scramble_reversed(uint x, uint seed) {
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return x;
}

// Four numbers in [0, 1) of sample `index` of the set that `seed` names.
vec4 sobol_sample(usamplerBuffer points, uint index, uint seed) {
    seed = seed_of(seed, index / SOBOL_POINTS);
    uint shuffled = bitfieldReverse(scramble_reversed(bitfieldReverse(index), seed)) & (SOBOL_POINTS - 1u);
    uvec4 point = texelFetch(points, int(shuffled));
    uvec4 scrambled = uvec4(
        scramble_reversed(point.x, seed_of(seed, 1u)), scramble_reversed(point.y, seed_of(seed, 2u)),
        scramble_reversed(point.z, seed_of(seed, 3u)), scramble_reversed(point.w, seed_of(seed, 4u)));
    return vec4(bitfieldReverse(scrambled) >> 8) * (1.0 / 16777216.0);
}

#endif
