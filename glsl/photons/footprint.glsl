// How the light of a photon lies around it: a Gaussian over the radius, of unit integral over the disc, on the surface that the photon landed on.
#ifndef PHOTONS_FOOTPRINT
#define PHOTONS_FOOTPRINT

#include "lib/vectors.glsl"

// K(0) of exp(−q²/2δ) / (2πδ(1 − exp(−1/2δ))), δ = 1/8: 0 from q = 1 on, where it has fallen to 1.8 % of this.
float gaussian_peak() {
    return 4.0 / (1.0 - exp(-4.0)) * INVERSE_PI;
}

// K(q)/K(0) of q², within the disc.
float gaussian_shape(float squared) {
    return exp2(-5.7707801635558535 * squared);
}

// A surface is taken for another where its normal is more than 60° off the photon's, or where it is too far off the disc's plane: a quarter of the radius, or what the
// positions of photons may be off their surfaces.
const float LEAST_COSINE = 0.5;
const float MOST_HEIGHT = 0.25;

// Metres from the disc's plane that a surface may be.
float allowed_height(float radius, float tolerance) {
    return max(MOST_HEIGHT * radius, tolerance);
}

#endif
