// A pixel on which photons fall, as the filter spreads its flux (points/spread.comp), in four texels (rgba32ui):
//
//   flux over the area that it is spread on, W/m² | pixels to each side
//   position in render space: the mean of its photons | normal, packed
//   first axis over its radius, 1/m | metres across a pixel
//   second axis likewise | unused
#ifndef POINTS_SOURCE
#define POINTS_SOURCE

#include "points/filter.glsl"

const uint SOURCE_TEXELS = 4u;

struct Source {
    vec3 light;
    int reach;
    Place place;  // but for its area
    Spreading spreading;
};

Source load_source(usamplerBuffer sources, uint index) {
    int first = int(SOURCE_TEXELS * index);
    uvec4 a = texelFetch(sources, first);
    uvec4 b = texelFetch(sources, first + 1);
    uvec4 c = texelFetch(sources, first + 2);
    uvec4 d = texelFetch(sources, first + 3);
    Place place = Place(uintBitsToFloat(b.xyz), unpack_direction(b.w), uintBitsToFloat(c.w), 0.0, true);
    return Source(uintBitsToFloat(a.xyz), int(a.w), place, Spreading(uintBitsToFloat(c.xyz), uintBitsToFloat(d.xyz)));
}

#endif
