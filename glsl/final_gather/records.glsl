// What is in the grids of the photon map (src/diffuse/final_gather/grid.rs), two texels (rgba32ui) each:
//
//   position | normal of the triangle, packed, on the side that light came to
//   flux in W of a photon, irradiance in W/m² of a point | number
//
// A photon's number is that of its path and of the surfaces it met before: it does not depend on the order in which photons were stored.
#ifndef FINAL_GATHER_RECORDS
#define FINAL_GATHER_RECORDS

#include "buckets/wrapped.glsl"
#include "lib/octahedral.glsl"

struct MapRecord {
    uvec4 place;
    uvec4 light;
};

// Surfaces that a photon meets at most: what walls of an albedo of 0.95 leave is 2·10⁻⁶.
const uint MOST_EVENTS = 256u;

uint number_of_photon(uint path, uint event) {
    return path * MOST_EVENTS + event;
}

// In [0, 1).
float chance_of(uint number, uint stream) {
    return float(seed_of(number, stream) >> 8) / 16777216.0;
}

ivec3 cell_of(vec3 position, float inverse_cell) {
    return ivec3(floor(position * inverse_cell));
}

#endif
