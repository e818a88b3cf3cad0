// How a photon's flux is spread over the disc of radius h: K(q)/h², q = d/h, of unit integral over the disc. (Quyen 2014 prints
// Φκ/(πh²), section 3.3.2.3, which does not conserve energy.)
//
//   cone      3(1 − q)/π
//   gaussian  photons/footprint.glsl
#ifndef PHOTON_SPLAT_KERNEL
#define PHOTON_SPLAT_KERNEL

#include "groups/splat.glsl"
#include "photons/footprint.glsl"

// K(0), by which stored fluxes are multiplied already.
float kernel_peak() {
    return GAUSSIAN != 0u ? gaussian_peak() : 3.0 * INVERSE_PI;
}

// K(q)/K(0) of q².
float kernel_shape(float squared) {
    float shape = GAUSSIAN != 0u ? gaussian_shape(squared) : 1.0 - sqrt(squared);
    return squared < 1.0 ? shape : 0.0;
}

#endif
