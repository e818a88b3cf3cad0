// Irradiance in whole multiples of a power of two, so that the order of photons, which differs from run to run, changes no bit of the sum.
#ifndef PHOTON_SPLAT_FIXED_POINT
#define PHOTON_SPLAT_FIXED_POINT

// The power of two by which everything up to `peak` comes out below 2^bits. Below 2^-100 it stops growing.
float fixed_point_scale(float peak, int bits) {
    int exponent = max(int(floatBitsToUint(peak) >> 23) - 126, -100);
    return uintBitsToFloat(uint(127 + bits - exponent) << 23);
}

uvec3 to_fixed(vec3 scaled) {
    return uvec3(ivec3(scaled + 0.5));
}

vec3 from_fixed(uvec3 low, uvec3 high, float scale) {
    return (vec3(high) * 4294967296.0 + vec3(low)) / scale;
}

#endif
