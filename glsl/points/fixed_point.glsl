// Flux in whole multiples of a power of two. Photons stand in their list in another order from run to run, and so would a blend unit add them: whole numbers have the
// same sum in any order, and images for atomics of 32 bits are on every device, where blending of 32-bit floats is not.
//
// The total flux of all photons has 2³¹ of them at most: even if all fell onto one pixel nothing overflows. What a photon carries below a whole is rounded up by chance with that probability, so that many faint
// photons beside a bright one keep their flux; the chance is drawn by the photon's own bits.
#ifndef POINTS_FIXED_POINT
#define POINTS_FIXED_POINT

#include "lib/sobol.glsl"

// Exponent of the scale by which 2^count_log2 photons of the largest flux have 2³¹ wholes; below 2^-80 W it stops growing.
int exponent_by_peak(uint peak_bits, uint count_log2) {
    int above_peak = max(int(peak_bits >> 23) - 126, -80);
    return 31 - int(count_log2) - above_peak;
}

float power_of_two(int exponent) {
    return uintBitsToFloat(uint(127 + exponent) << 23);
}

// By which flux is multiplied. `fluxes`: the bits of the largest flux · the total flux in wholes of the scale by the peak, rounded up photon by photon. 2^count_log2 is
// the number of photons at least.
float fixed_point_scale(usamplerBuffer fluxes, uint count_log2) {
    uint total = max(texelFetch(fluxes, 1).x, 1u);
    int total_log2 = total > 1u ? findMSB(total - 1u) + 1 : 0;
    return power_of_two(min(exponent_by_peak(texelFetch(fluxes, 0).x, count_log2) + 31 - total_log2, 127));
}

float chance_of(vec3 position_rs) {
    uvec3 bits = floatBitsToUint(position_rs);
    return float(seed_of(seed_of(bits.x, bits.y), bits.z) >> 8) * (1.0 / 16777216.0);
}

uvec3 fixed_point(vec3 flux, float scale, float chance) {
    return uvec3(flux * scale + chance);
}

#endif
