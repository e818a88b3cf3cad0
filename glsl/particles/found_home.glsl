// The particle that stands for where a ray ends, as found for its facet before (catch.comp).
#ifndef PARTICLES_FOUND_HOME
#define PARTICLES_FOUND_HOME

#include "particles/facets.glsl"
#include "particles/home_words.glsl"

layout(set = 0, binding = 7) uniform usamplerBuffer facets;
layout(set = 0, binding = 8) uniform usamplerBuffer homes;  // of facets

const uint NO_PARTICLE = LOST_FACET;

// `back`: the ray came from behind.
uint found_home(uint triangle, vec2 place, bool back) {
    uint facet = facet_of(facets, triangle, place, back);
    return facet == NO_FACET ? NO_PARTICLE : texelFetch(homes, int(facet)).x;
}

#endif
