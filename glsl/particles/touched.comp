#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "particles/moved.glsl"
#include "particles/places.glsl"

// Whether something moved so near one particle that other points may be nearer to it than before, or are hidden from it, or that its list is another one.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer moved_triangles;
layout(set = 0, binding = 1) uniform samplerBuffer boxes;
layout(set = 0, binding = 2) buffer Touched { uint touched[]; };
layout(set = 0, binding = 3) buffer Counts { uint counts[]; };  // particles: on what moved, touched, whose lists are

layout(push_constant, scalar) uniform Push {
    uint particle_count;
    uint box_count;
} push;

// Spacings. A point is less than one from its particle; what stands within two of a particle decides whether segments to it are tested (crowd.comp).
const float NEAR = 2.0;
// Lists reach three (list.comp).
const float LIST_NEAR = 3.5;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    vec3 position = uintBitsToFloat(texelFetch(particle_places, int(particle)).xyz);
    bool moved = has_moved(moved_triangles, texelFetch(particle_places, second_place(particle_places, particle)).y);
    float distance2 = moved ? 0.0 : 3e38;
    for (uint number = 0u; number < push.box_count; ++number) {
        vec3 way = max(max(low_corner(boxes, number) - position, position - high_corner(boxes, number)), vec3(0.0));
        distance2 = min(distance2, dot(way, way));
    }
    float spacings = sqrt(distance2) / particle_spacing;
    uint bits = (spacings <= NEAR ? TOUCHED : 0u) | (spacings <= LIST_NEAR ? LIST_TOUCHED : 0u);
    if (bits != 0u) {
        atomicOr(touched[particle >> 4], bits << (2u * (particle & 15u)));
        atomicAdd(counts[0], moved ? 1u : 0u);
        atomicAdd(counts[1], bits & TOUCHED);
        atomicAdd(counts[2], bits >> 1);
    }
}
