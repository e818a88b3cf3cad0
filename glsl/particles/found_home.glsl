// The particle that stands for where a ray ends, as found for its facet before (catch.comp), or searched where something stands on the facet.
#ifndef PARTICLES_FOUND_HOME
#define PARTICLES_FOUND_HOME

#include "particles/facets.glsl"
#include "particles/home.glsl"
#include "particles/home_words.glsl"

layout(set = 0, binding = 7) readonly buffer Facets { uint facets[]; };  // records of triangles and of cells (facets.glsl)
layout(set = 0, binding = 8) readonly buffer Homes { uint homes[]; };    // of facets

// Of a point of a triangle, by the weights of corners 1 and 2.
uint facet_of(uint triangle, vec2 place, bool back) {
    Cuts cells = unpack_cuts(facets[2u * triangle + 1u]);
    if (parts_of(cells) == 0u || (back && cells.sides == 1u)) {
        return NO_FACET;
    }
    vec2 at = along_and_across(cells.apex, place);
    uint cell = facets[2u * triangle] + part_at(cells, back, at);
    return facets[2u * cell] + part_at(unpack_cuts(facets[2u * cell + 1u]), false, at);
}

// A ray of `length` along `direction` met the triangle, whose front has that normal, at `position`.
uint found_home(uint triangle, vec2 place, vec3 front, vec3 position, vec3 direction, float length) {
    bool back = dot(front, direction) > 0.0;
    uint facet = facet_of(triangle, place, back);
    uint word = facet == NO_FACET ? LOST_FACET : homes[facet];
    if (word == LOST_FACET || (word & PARTED_FACET) == 0u) {
        return word == LOST_FACET ? NO_PARTICLE : word;
    }
    vec3 normal = back ? -front : front;
    return home_of(position, normal, lift_of_point(position, normal, -direction, length));
}

#endif
