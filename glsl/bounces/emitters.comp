#version 460
#include "lib/prelude.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "bounces/samples.glsl"
#include "bounces/sum_of_lanes.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/emitter_hits.glsl"
#include "lib/emitters.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"

// One group of invocations a sample of the surfaces: the irradiance from emissive surfaces, W/m², from points y of them, drawn by power,
//
//   E(s) ≈ 1/N Σ_k L_e(y_k) · (n·l_k)⁺ · V · w_k / p_k        p = P(triangle) p(y) · d²/(n_y·−l)   [1/sr]
//
// weighted against M directions that find the same light (bounces/directions.comp) by the power heuristic (Veach & Guibas 1995).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer samples;
layout(set = 0, binding = 1) writeonly buffer ArrivedBlock { vec4 arrived[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint emitter_count;
    uint point_count;      // N
    uint direction_count;  // M
    float density_scale;   // from a point's density among all lights to that among emissive triangles
} push;

vec3 light_of_point(SurfaceSample receiver, vec3 origin, vec4 random) {
    Emitter emitter = pick_emitter(emissive_triangles, push.emitter_count, random.x);
    Triangle triangle = load_triangle(triangles, emitter.number);
    Material material = load_material(materials, triangle.material);
    EmissivePoint point = draw_emissive_point(triangle, random.yz);
    vec3 front = front_normal(triangle);
    vec3 target = point_of_triangle(triangle, point.place, front);
    vec3 way = target - receiver.position;
    float distance2 = max(dot(way, way), 1e-30);
    vec3 to_light = way * inversesqrt(distance2);
    float cosine = -dot(front, to_light);
    cosine = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? abs(cosine) : cosine;
    float received = dot(receiver.normal, to_light);
    if (min(cosine, received) <= 0.0) {
        return vec3(0.0);
    }
    float density = point.density * push.density_scale * distance2 / max(cosine, 1e-9);
    float weight = power_heuristic(float(push.point_count) * density, float(push.direction_count) * received * INVERSE_PI);
    vec3 light = covered_radiance(triangle, material, point.place) * (received * weight / density);
    bool hidden = max3(light) <= 0.0 || is_occluded(origin, target - origin, 1.0);
    return hidden ? vec3(0.0) : light;
}

void main() {
    uint self = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (self >= push.slot_count) {
        return;
    }
    SurfaceSample receiver = load_sample(samples, self);
    vec3 origin = offset_ray_origin(receiver.position, receiver.normal);
    vec3 found = vec3(0.0);
    uint count = receiver.area > 0.0 ? push.point_count : 0u;
    for (uint number = gl_LocalInvocationIndex; number < count; number += 64u) {
        found += light_of_point(receiver, origin, sobol_sample(sobol, number, seed_of(self, 0xE31u)));
    }
    vec3 sum = sum_of_lanes(found);
    if (gl_LocalInvocationIndex == 0u) {
        arrived[self] = vec4(sum / float(push.point_count), 0.0);
    }
}
