// A photon as it is splatted, three texels of four words (rgba32ui), and what it gives to a point.
//
//   0   position in render space | h in m
//   1   Φ·K(0)/h² in W/m² | geometric normal, packed
//   2   squeeze in 1/m | 0
//
// An ellipse is the disc of its larger radius h, squeezed along its smaller one h₂: with s = e·√(1/h₂² − 1/h²), e that direction, the distance
// over the radius is q² = d²/h² + (d·s)², and Φ·K(0)/(h·h₂) stands in texel 1.
//
// A point x with normal n_x gets the irradiance Φ·K(d/h)/h²·(n_x·n), d the distance in the disc's plane: n_x·n makes the integral over any
// surface that the disc's axis meets once equal Φ. The surface is taken for another, and gets nothing, where n_x is more than 60° off
// n or x too far off the disc's plane: h/4, or what the positions of photons may be off their surfaces.
#ifndef PHOTON_SPLAT_DISC
#define PHOTON_SPLAT_DISC

#include "photons/footprint.glsl"

// In place of the cell of a photon that is left out.
const uint NO_CELL = 0xFFFFFFFFu;

#endif
