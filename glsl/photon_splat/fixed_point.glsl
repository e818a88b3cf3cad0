// Irradiance in whole multiples of a power of two, so that the order of photons, which differs from run to run, changes no bit of the sum.
#ifndef PHOTON_SPLAT_FIXED_POINT
#define PHOTON_SPLAT_FIXED_POINT

// Terms come out at most 2^28, so that eight of them stay below 2^32 and 2^36 of them below 2^64.
const int TERM_BITS = 28;

// The power of two by which terms up to `peak` are multiplied. Below 2^-90 it stops growing.
float fixed_point_scale(float peak) {
    int exponent = max(int(floatBitsToUint(peak) >> 23) - 126, -90);
    return uintBitsToFloat(uint(127 + TERM_BITS - exponent) << 23);
}

uvec3 to_fixed(vec3 scaled, float weight) {
    return uvec3(ivec3(fma(scaled, vec3(weight), vec3(0.5))));
}

vec3 from_fixed(uvec3 low, uvec3 high, float scale) {
    return (vec3(high) * 4294967296.0 + vec3(low)) / scale;
}

#endif
