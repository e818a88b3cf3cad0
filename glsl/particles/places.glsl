// Where a particle is, by its number: a texel with position and packed shading normal, and behind those of all particles another one with the packed normal of
// its triangle, on the particle's side, the triangle, the particle's spacing, m, and the same as a step (widths.glsl).
#ifndef PARTICLES_PLACES
#define PARTICLES_PLACES

#include "lib/octahedral.glsl"

// Texel of the second kind.
int second_place(usamplerBuffer places, uint particle) {
    return textureSize(places) / 2 + int(particle);
}

// Spacings of the closest particles from which on one is wide: it stands for four times as much surface.
const float WIDE_SPACINGS = 2.0;

// How far particles are apart around it, m.
float spacing_of_particle(usamplerBuffer places, uint particle) {
    return uintBitsToFloat(texelFetch(places, second_place(places, particle)).z);
}

vec3 face_of_particle(usamplerBuffer places, uint particle) {
    return unpack_direction(texelFetch(places, second_place(places, particle)).x);
}

#endif
