// Photons that are kept where they landed, in three texels each (rgba32ui):
//
//   position in render space | geometric normal on the side that the photon arrived at, packed
//   flux rgb in W            | larger radius in m of the ellipse that the photon stands for (photons/beam.glsl)
//   direction of the smaller radius, packed | its length in m | unused (2)
//
// A place without flux holds no photon.
#ifndef PHOTONS_KEPT
#define PHOTONS_KEPT

#include "lib/octahedral.glsl"
#include "lib/vectors.glsl"

struct KeptPhoton {
    vec3 position_rs;
    vec3 normal;
    vec3 flux;
    float larger;
    vec3 narrow_axis;
    float smaller;
};

vec3 flux_of_kept(usamplerBuffer photons, uint index) {
    return uintBitsToFloat(texelFetch(photons, 3 * int(index) + 1).xyz);
}

KeptPhoton load_kept(usamplerBuffer photons, uint index) {
    uvec4 place = texelFetch(photons, 3 * int(index));
    uvec4 carried = texelFetch(photons, 3 * int(index) + 1);
    uvec4 ellipse = texelFetch(photons, 3 * int(index) + 2);
    return KeptPhoton(
        uintBitsToFloat(place.xyz), unpack_direction(place.w), uintBitsToFloat(carried.xyz), uintBitsToFloat(carried.w),
        unpack_direction(ellipse.x), uintBitsToFloat(ellipse.y));
}

#endif
