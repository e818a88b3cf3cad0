// Where fragments lie on the front plane of a hemicube, and how much of the cosine-weighted hemisphere they span.
#ifndef HEMICUBE_WEIGHT
#define HEMICUBE_WEIGHT

#include "lib/vectors.glsl"

// The middle of fragment `place` of `side`², on a plane at a distance of 1 that reaches from −`plane` to `plane`.
vec2 middle_of_fragment(uvec2 place, uint side, float plane) {
    return plane * ((2.0 * vec2(place) + 1.0) / float(side) - 1.0);
}

// F = ΔA/(π(x² + y² + 1)²) (Larsen & Christensen 2004, equation 2; Cohen & Greenberg 1985).
float weight_of(uvec2 place, uint side, float plane) {
    vec2 point = middle_of_fragment(place, side, plane);
    float length2 = dot(point, point) + 1.0;
    float width = 2.0 * plane / float(side);
    return INVERSE_PI * width * width / (length2 * length2);
}

#endif
