// The filter of equation 4 of Larsen & Christensen 2004, as weights of the surface at one pixel for the flux at another.
//
//   screen   √(1 + 2k² − i² − j²) for a step of (i, j) pixels, |i|, |j| ≤ k = 3. Their sum is 156.76; each is divided by what they sum up to where they are used, so
//            that no light is lost at the edges of the screen and of surfaces
//   world    exp(−4q), q = wᵀC⁻¹w < 1, for points that are w metres apart in the plane of the surface (points/width.glsl): the Gaussian of which even light is the sum
//            where photons lie on a lattice of the spacing that C tells (photons/beam.glsl)
#ifndef POINTS_FILTER
#define POINTS_FILTER

#include "points/place.glsl"
#include "points/width.glsl"

// The axes of an ellipse in the plane of the surface, over its radii.
struct Spreading {
    vec3 first;
    vec3 second;
};

float weight_of(Place source, Spreading spreading, Place receiver, ivec2 step) {
    if (!receiver.valid || !is_same_surface(source, receiver.position_rs, receiver.normal)) {
        return 0.0;
    }
    if (WORLD == 0u) {
        const float k = float(SCREEN_REACH);
        return sqrt(1.0 + 2.0 * k * k - float(step.x * step.x + step.y * step.y));
    }
    vec3 way = receiver.position_rs - source.position_rs;
    vec2 along = vec2(dot(way, spreading.first), dot(way, spreading.second));
    float q = dot(along, along);
    // The pixel itself has its share, however narrow the ellipse and however slanted the surface.
    q = step == ivec2(0) ? min(q, 0.999) : q;
    return q < 1.0 ? exp(-4.0 * q) : 0.0;
}

#endif
