// Samples of all diffuse surface, each of which stands for as much area (src/frame/rays/samples.rs), in clusters of neighbours. Two texels (rgba32ui) each:
//   [2s]     the position in the rays' space, and the area, m², as floats' bits; of an empty place 0
//   [2s + 1] the packed normal of its side, the triangle, the weights of its corners 1 and 2
// The first sample of a cluster is never empty.
#ifndef BOUNCES_SAMPLES
#define BOUNCES_SAMPLES

#include "lib/octahedral.glsl"

struct SurfaceSample {
    vec3 position;
    float area;
    vec3 normal;
    uint triangle;
    vec2 place;
};

SurfaceSample load_sample(usamplerBuffer samples, uint index) {
    uvec4 first = texelFetch(samples, int(2u * index));
    uvec4 second = texelFetch(samples, int(2u * index + 1u));
    return SurfaceSample(
        uintBitsToFloat(first.xyz), uintBitsToFloat(first.w), unpack_direction(second.x), second.y, uintBitsToFloat(second.zw));
}

bool face_each_other(SurfaceSample a, SurfaceSample b) {
    vec3 way = b.position - a.position;
    return a.area > 0.0 && b.area > 0.0 && dot(a.normal, way) > 0.0 && dot(b.normal, way) < 0.0;
}

#endif
