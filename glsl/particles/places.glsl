// Where a particle is, by its number: a texel with position and packed shading normal, and behind those of all particles another one with the packed normal of
// its triangle, on the particle's side, and the triangle.
#ifndef PARTICLES_PLACES
#define PARTICLES_PLACES

#include "lib/octahedral.glsl"

// Texel of the second kind.
int second_place(usamplerBuffer places, uint particle) {
    return textureSize(places) / 2 + int(particle);
}

vec3 face_of_particle(usamplerBuffer places, uint particle) {
    return unpack_direction(texelFetch(places, second_place(places, particle)).x);
}

#endif
