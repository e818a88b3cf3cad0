// Photons and their paths. Each has room for where it starts and for the surfaces that it meets, two texels (rgba32ui) each:
//
//   position | the texel of light maps that is nearest; NO_TEXEL: none that light is kept for
//   flux that came there, W | 0, PATH_ENDED or PATH_LEFT
//
// Photons are numbered group by group, and groups light by light.
#ifndef LIGHTMAPS_PHOTONS
#define LIGHTMAPS_PHOTONS

const uint PHOTONS_A_GROUP = 40u;
// What is there of a path: the start, and surfaces. At an albedo of 0.8 a path is longer with a chance of 0.03.
const uint RECORDS_A_PHOTON = 16u;

// The path ends before it.
const uint PATH_ENDED = 1u;
// The path ends after a ray towards its position that meets nothing which takes light, however far.
const uint PATH_LEFT = 2u;

uint record_of(uint photon, uint event) {
    return 2u * (photon * RECORDS_A_PHOTON + event);
}

#endif
