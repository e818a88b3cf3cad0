// Flux in whole multiples of a power of two. Photons stand in their list in another order from run to run, and so would a blend unit add them: whole numbers have the
// same sum in any order, and images for atomics of 32 bits are on every device, where blending of 32-bit floats is not.
//
// Even if all photons fell onto one pixel nothing overflows. What a photon carries below a whole is rounded up by chance with that probability, so that many faint
// photons beside a bright one keep their flux; the chance is drawn by the photon's own bits.
#ifndef POINTS_FIXED_POINT
#define POINTS_FIXED_POINT

#include "lib/sobol.glsl"

// By which flux is multiplied. 2^count_log2 is the number of photons at least; below 2^-80 W the scale stops growing.
float fixed_point_scale(uint peak_bits, uint count_log2) {
    int above_peak = max(int(peak_bits >> 23) - 126, -80);
    return uintBitsToFloat(uint(127 + 31 - int(count_log2) - above_peak) << 23);
}

float chance_of(vec3 position_rs) {
    uvec3 bits = floatBitsToUint(position_rs);
    return float(seed_of(seed_of(bits.x, bits.y), bits.z) >> 8) * (1.0 / 16777216.0);
}

uvec3 fixed_point(vec3 flux, float scale, float chance) {
    return uvec3(flux * scale + chance);
}

#endif
