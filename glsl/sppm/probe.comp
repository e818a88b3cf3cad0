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

#include "path/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/octahedral.glsl"
#include "lib/microfacet.glsl"

// Of the sample sequence, one a ray.
const uint STREAM_PROBE = 0x40000000u;
const uint MOST_RAYS = 64u;

// The conditions of sppm/gather.comp; textures of metals and of glass are not asked.
bool takes_photons(Hit hit, vec3 offset, vec3 normal) {
    if (hit.triangle == NO_TRIANGLE || dot(offset, offset) >= push.radius * push.radius) {
        return false;
    }
    Triangle triangle = load_triangle(triangles, hit.triangle);
    Material material = load_material(materials, triangle.material);
    float diffuse = max3(material.base_color.rgb) * (1.0 - material.metallic) * (1.0 - material.transmission);
    return diffuse > 0.0 && abs(dot(front_normal(triangle), normal)) > 0.5;
}

void main() {
    uint path = queued_path(point_queue);
    if (path == NO_PATH) {
        return;
    }
    uint first = uint(POINT_TEXELS) * path;
    vec3 position = uintBitsToFloat(points[first].xyz);
    vec3 normal = unpack_direction(points[first].w);
    Frame frame = frame_around(normal);
    uvec2 seed = texelFetch(path_seeds, int(path)).xy;
    uint rays = 0u;
    bool met = false;
    [[dont_unroll]] while (!met && rays < MOST_RAYS) {
        vec2 random = sobol_sample(sobol, seed.y, seed_of(seed.x, STREAM_PROBE + rays)).xy;
        float distance = push.radius * sqrt(random.x);
        float azimuth = 2.0 * PI * random.y;
        vec3 across = distance * (cos(azimuth) * frame.tangent + sin(azimuth) * frame.bitangent);
        Hit hit = closest_hit(position + across + 0.25 * push.radius * normal, -normal, 0.5 * push.radius);
        met = takes_photons(hit, across + (0.25 * push.radius - hit.distance) * normal, normal);
        ++rays;
    }
    points[first + 2u].w = rays;
}
