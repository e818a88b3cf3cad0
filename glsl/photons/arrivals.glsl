// Photons that reached a surface with specular lobes and wait to be sent on, in two lists:
//
//   arrivals   3 texels   as a ray of photons/records.glsl whose origin is the point that it reached, and `travelled` the way so far
//   surfaces   2 texels   shading normal | geometric normal | √f0 | √transmission           (photons/surface_texel.glsl)
//                         f90, roughness | relative index beyond the surface, 1: a thin wall | gap | bent normal
//
// Bent normal: the shading normal where the photon sits in its texel, which says where it goes; what it carries follows from the shading normal
// of the whole texel, so that the flux is right.
// Gap: metres that a ray starts away from the surface, so that rounding does not let it meet that again.
#ifndef PHOTONS_ARRIVALS
#define PHOTONS_ARRIVALS

#include "photons/records.glsl"

// Of a point that was computed in floats from a ray of length `way`: 64 units in the last place of what is larger, that or its coordinates.
float gap_at(vec3 position_rs, float way) {
    vec3 size = abs(position_rs);
    return exp2(-18.0) * max(way, max(size.x, max(size.y, size.z)));
}

#endif
