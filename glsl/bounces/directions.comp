#version 460
#include "lib/prelude.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "bounces/samples.glsl"
#include "bounces/sum_of_lanes.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/emitter_hits.glsl"
#include "lib/microfacet.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"

// One group of invocations a sample of the surfaces: the irradiance from the sky, W/m², and what emissive surfaces add that a direction meets,
//
//   E(s) ≈ π/N Σ_k L(l_k) · w_k        l_k drawn by the cosine
//
// The light of emitters is weighted against the points of them that bounces/emitters.comp draws.

layout(local_size_x = 64) in;

// 1: directions look for emitters, not for the sky alone, and add to what points of these gave.
layout(constant_id = 0) const uint FINDS_EMITTERS = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer samples;
layout(set = 0, binding = 1) uniform samplerBuffer by_points;
layout(set = 0, binding = 2) writeonly buffer ArrivedBlock { vec4 arrived[]; };

layout(push_constant, scalar) uniform Push {
    vec3 sky;             // W/(m²·sr)
    uint slot_count;
    uint direction_count;
    float density_scale;  // as in emitters.comp, times points over directions
} push;

vec3 light_from(vec3 origin, vec3 direction, float density) {
    Hit hit = traverse(origin, direction, 3e38, FINDS_EMITTERS == 0u);
    if (hit.triangle == NO_TRIANGLE) {
        return push.sky;
    }
    return FINDS_EMITTERS == 0u ? vec3(0.0) : weighted_radiance(hit, direction, density, push.density_scale);
}

void main() {
    uint self = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (self >= push.slot_count) {
        return;
    }
    SurfaceSample receiver = load_sample(samples, self);
    vec3 origin = offset_ray_origin(receiver.position, receiver.normal);
    vec3 found = vec3(0.0);
    uint count = receiver.area > 0.0 ? push.direction_count : 0u;
    for (uint number = gl_LocalInvocationIndex; number < count; number += 64u) {
        vec4 random = sobol_sample(sobol, number, seed_of(self, 0xD1Bu));
        float radius = sqrt(random.x);
        float azimuth = 2.0 * PI * random.y;
        vec3 local = vec3(radius * cos(azimuth), radius * sin(azimuth), sqrt(max(1.0 - random.x, 1e-7)));
        found += light_from(origin, to_world(frame_around(receiver.normal), local), local.z * INVERSE_PI);
    }
    vec3 sum = sum_of_lanes(found);
    if (gl_LocalInvocationIndex == 0u) {
        vec3 before = FINDS_EMITTERS != 0u ? texelFetch(by_points, int(self)).rgb : vec3(0.0);
        arrived[self] = vec4(before + sum * (PI / float(push.direction_count)), 0.0);
    }
}
