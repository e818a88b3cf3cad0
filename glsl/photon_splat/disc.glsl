// A photon as it is splatted, three texels of four words (rgba32ui), and what it gives to a point.
//
//   0   position in render space | 1/h in 1/m
//   1   Φ·K(0)/h² in W/m² | geometric normal, packed
//   2   squeeze | 0
//
// An ellipse is the disc of its larger radius h, squeezed along its smaller one h₂: with s = e·√((h/h₂)² − 1), e that direction, the distance
// over the radius is q² = (d² + (d·s)²)/h², and Φ·K(0)/(h·h₂) stands in texel 1.
//
// A point x with normal n_x gets the irradiance Φ·K(d/h)/h²·(n_x·n), d the distance in the disc's plane: n_x·n makes the integral over any
// surface that the disc's axis meets once equal Φ. The surface is taken for another, and gets nothing, where n_x is more than 60° off
// n or x too far off the disc's plane: h/4, or what the positions of photons may be off their surfaces.
#ifndef PHOTON_SPLAT_DISC
#define PHOTON_SPLAT_DISC

#include "lib/octahedral.glsl"
#include "photon_splat/kernel.glsl"

const float LEAST_COSINE = 0.5;
const float MOST_HEIGHT = 0.25;

// How far from the disc's plane a surface may be, over h.
float allowed_height(float inverse_radius, float tolerance) {
    return max(MOST_HEIGHT, tolerance * inverse_radius);
}

// The share of texel 1's irradiance that a point gets. `offset`: from the disc's centre, over h.
float disc_weight(vec3 offset, vec3 normal, vec3 disc_normal, vec3 squeeze, float height_limit) {
    float cosine = dot(normal, disc_normal);
    float height = dot(offset, disc_normal);
    float squared = max(dot(offset, offset) - height * height, 0.0);
    if (ELLIPTIC != 0u) {
        float squeezed = dot(offset, squeeze);
        squared += squeezed * squeezed;
    }
    bool same_surface = cosine > LEAST_COSINE && abs(height) < height_limit;
    return same_surface ? kernel_shape(squared) * cosine : 0.0;
}

#endif
