#version 460
#include "lib/prelude.glsl"
#include "groups/paths.glsl"
#include "groups/scene_rays.glsl"
#include "lib/sobol.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "sppm/photon.glsl"

// What share p of a measurement point's disc is surface that photons could lie on: where it ends, around corners and at edges, a
// density of photons over the whole disc would be too low. Rays through random points of the disc are cast until one
// meets such surface; their number, a geometric variable, is 1/p on average (Booth 2007; Qin et al. 2015).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer point_queue;
layout(set = 0, binding = 1) buffer PointBlock { uvec4 points[]; };

layout(push_constant, scalar) uniform Push {
    float radius;  // m
    uint reserved;
} push;

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/disc_surface.glsl"
#include "lib/octahedral.glsl"

// Of the sample sequence, one a ray.
const uint STREAM_PROBE = 0x40000000u;
const uint MOST_RAYS = 64u;

void main() {
    uint path = queued_path(point_queue);
    if (path == NO_PATH) {
        return;
    }
    uint first = uint(POINT_TEXELS) * path;
    vec3 position = uintBitsToFloat(points[first].xyz);
    Frame frame = frame_around(unpack_direction(points[first].w));
    uvec2 seed = texelFetch(path_seeds, int(path)).xy;
    uint rays = 0u;
    bool met = false;
    [[dont_unroll]] while (!met && rays < MOST_RAYS) {
        vec2 random = sobol_sample(sobol, seed.y, seed_of(seed.x, STREAM_PROBE + rays)).xy;
        met = meets_disc_surface(position, frame, push.radius, random);
        ++rays;
    }
    points[first + 2u].w = rays;
}
