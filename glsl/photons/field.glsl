// Landed photons in a grid over space, found by the points that they light (src/frame/photons/field.rs).
//
// The cells of level l have a side of 2^-l of the coarsest ones'. A photon stands in the finest level whose cells are twice as wide as the larger radius h of its ellipse
// or wider, in the cell of its middle: so the eight cells around a point have all photons of a level that reach it. The cells of all levels share the buckets of one table; each
// photon tells its level and its cell by itself. It has three texels (rgba32ui):
//
//   position in the rays' space | level
//   Φ·K(0)/(h·h₂), W/m² | 1/h², 1/m²
//   squeeze, 1/m (photon_splat/disc.glsl) | geometric normal on the side that it arrived at, packed
#ifndef PHOTONS_FIELD
#define PHOTONS_FIELD

#include "lib/octahedral.glsl"
#include "lib/sobol.glsl"
#include "photons/footprint.glsl"

const uint FIELD_TEXELS = 3u;
const uint FINEST_LEVEL = 15u;
const uint NO_BUCKET = 0xFFFFFFFFu;

// What is known of all photons.
const uint STATE_LEVELS = 0u;   // a bit for each level that has some
const uint STATE_PEAK = 1u;     // the brightest middle of an ellipse, W/m², as a float's bits
const uint STATE_PHOTONS = 2u;  // how many there are

// Of a larger radius up to half the side of the coarsest cells.
uint level_of(float radius, float coarsest) {
    float ratio = clamp(0.5 * coarsest / radius, 1.0, float(1u << FINEST_LEVEL));
    return (floatBitsToUint(ratio) >> 23) - 127u;
}

// Powers of two change no digit: whoever asks gets the same cell.
ivec3 cell_of(vec3 position, uint level, float inverse_coarsest) {
    return ivec3(floor(position * (uintBitsToFloat((127u + level) << 23) * inverse_coarsest)));
}

uint bucket_of_cell(ivec3 cell, uint level, uint bucket_mask) {
    uvec3 words = uvec3(cell);
    return seed_of(mix_bits(words.x ^ mix_bits(words.y ^ mix_bits(words.z))), level) & bucket_mask;
}

#endif
