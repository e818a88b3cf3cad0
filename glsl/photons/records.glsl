// The records of photons on their way (src/frame/photons/records.rs), in texels of four words:
//
//   rays     3   origin in render space, moved off its surface | way so far in m
//                direction (unit) | PHOTON_ bits
//                flux rgb in W | seed
//   hits     1   distance along the ray, as the bits of a float: HIT_NONE if there is none | the surface's own geometric normal, packed,
//                as its winding has it | material | triangle of the traced scene, or NO_TRIANGLE where lists were traced
//   photons  2   position in render space | geometric normal on the side that the photon arrived at, packed
//                flux rgb in W | radius of the disc in m: of an ellipse the larger one
//   ellipses 1   direction of the smaller radius | its length in m, where it differs
#ifndef PHOTONS_RECORDS
#define PHOTONS_RECORDS

#include "lib/octahedral.glsl"

const uint HIT_NONE = 0xFFFFFFFFu;
#ifndef LIB_BVH
const uint NO_TRIANGLE = 0xFFFFFFFFu;
#endif

const uint PHOTON_INSIDE = 1u;  // the ray runs inside a closed transmissive body

const uint STAGE_WORDS = 8u;
const uint COUNT_WORD = 3u;
const uint DRAW_WORD = 4u;

struct PhotonRay {
    vec3 origin_rs;
    float travelled;
    vec3 direction;
    uint bits;
    vec3 flux;
    uint seed;
};

PhotonRay load_photon_ray(usamplerBuffer rays, uint index) {
    uvec4 a = texelFetch(rays, 3 * int(index));
    uvec4 b = texelFetch(rays, 3 * int(index) + 1);
    uvec4 c = texelFetch(rays, 3 * int(index) + 2);
    return PhotonRay(
        uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), c.w);
}

struct Photon {
    vec3 position_rs;
    vec3 normal;
    vec3 flux;
    float radius;
};

Photon load_photon(usamplerBuffer photons, uint index) {
    uvec4 a = texelFetch(photons, 2 * int(index));
    uvec4 b = texelFetch(photons, 2 * int(index) + 1);
    return Photon(uintBitsToFloat(a.xyz), unpack_direction(a.w), uintBitsToFloat(b.xyz), uintBitsToFloat(b.w));
}

#endif
