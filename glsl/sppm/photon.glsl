// The photon map of one pass: what `store` leaves of light paths, and what `measure` leaves of camera paths.
//
//   photons  3 texels (rgba32ui)   position | bucket · flux in W, after the way | direction that it came from ·
//                                  geometric normal on its side | scatterings before | 1: the last was specular | cosine at arrival
//   points   3 texels (rgba32ui)   position | geometric normal · diffuse albedo times throughput/P(D) | shading normal ·
//                                  greatest f0 and f90 (unorm16 each) | direction to the viewer | vertices before | rays of `probe`
//
// The grid's cells have sides of two radii, so that a disc touches two cells along each axis.
#ifndef SPPM_PHOTON
#define SPPM_PHOTON

#include "buckets/wrapped.glsl"

const int PHOTON_TEXELS = 3;
const int POINT_TEXELS = 3;

#endif
