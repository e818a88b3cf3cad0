// What is counted of each particle, in whole numbers: one or two texels of four words.
#ifndef PARTICLES_TALLIES
#define PARTICLES_TALLIES

// 1: some surface has a broad specular lobe.
layout(constant_id = 0) const uint BROAD_LOBES = 0u;

const float ALBEDO_STEPS = 4095.0;
// Steps of an area that is as large as a facet may be; where particles do not lie evenly, of a quarter of the largest.
const float AREA_STEPS = 128.0;

// m²
float area_step(float size) {
    return size * size / AREA_STEPS;
}

uint tally_texels() {
    return 1u + BROAD_LOBES;
}

#endif
