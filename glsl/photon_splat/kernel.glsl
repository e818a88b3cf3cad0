// How a photon's flux is spread over the disc of radius h: K(q)/h², q = d/h, of unit integral over the disc. (Quyen 2014 prints
// Φκ/(πh²), section 3.3.2.3, which does not conserve energy.)
//
//   cone      3(1 − q)/π
//   gaussian  exp(−q²/2δ) / (2πδ(1 − exp(−1/2δ))), 0 from q = 1 on, where it has fallen to 1.8 % of its peak: δ = 1/8
#ifndef PHOTON_SPLAT_KERNEL
#define PHOTON_SPLAT_KERNEL

#include "groups/splat.glsl"
#include "lib/vectors.glsl"

// K(0), by which stored fluxes are multiplied already.
float kernel_peak() {
    return (GAUSSIAN != 0u ? 4.0 / (1.0 - exp(-4.0)) : 3.0) * INVERSE_PI;
}

// K(q)/K(0) of q².
float kernel_shape(float squared) {
    float shape = GAUSSIAN != 0u ? exp2(-5.7707801635558535 * squared) : 1.0 - sqrt(squared);
    return squared < 1.0 ? shape : 0.0;
}

#endif
