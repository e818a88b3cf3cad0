// The particle that stands for where a ray ends, as found for its facet before (catch.comp), or searched where something stands on the facet.
#ifndef PARTICLES_FOUND_HOME
#define PARTICLES_FOUND_HOME

#include "particles/facets.glsl"
#include "particles/home.glsl"
#include "particles/home_words.glsl"

layout(set = 0, binding = 7) readonly buffer Facets { uint facets[]; };  // two words of each triangle (facets.glsl)
layout(set = 0, binding = 8) readonly buffer Homes { uint homes[]; };    // of facets

// A ray of `length` along `direction` met the triangle, whose front has that normal, at `position`.
uint found_home(uint triangle, vec2 place, vec3 front, vec3 position, vec3 direction, float length) {
    bool back = dot(front, direction) > 0.0;
    uint facet = facet_of(uvec2(facets[2u * triangle], facets[2u * triangle + 1u]), place, back);
    uint word = facet == NO_FACET ? LOST_FACET : homes[facet];
    if (word == LOST_FACET || (word & PARTED_FACET) == 0u) {
        return word == LOST_FACET ? NO_PARTICLE : word;
    }
    vec3 normal = back ? -front : front;
    return home_of(position, normal, lifted(position, normal, -direction, length, spacing_of_particles()));
}

#endif
