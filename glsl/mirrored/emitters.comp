#version 460
#include "lib/prelude.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "mirrored/points.glsl"
#include "lib/emitter_hits.glsl"
#include "lib/emitters.glsl"
#include "lib/sobol.glsl"
#include "lib/narrow.glsl"
#include "mirrored/samples.glsl"

// What emissive surfaces send to one listed point, and it to its pixel, from points y drawn by power:
//
//   w/N Σ_k f(l_k, v) · (n·l_k)⁺ · L_e(y_k) · V / p_k        p = P(triangle) p(y) · d²/(n_y·−l)   [1/sr]
//
// f holds the diffuse lobe, and the specular one if it is wide: what narrow ones answer to, their rays find (trace/walk.comp). At first surfaces of samples directions spread
// by the cosine look for the light of the diffuse lobe too, as many as points; each of the two is weighted by the power heuristic. Points alone are noisy where an
// emitter is near.

layout(local_size_x = 64) in;

// 1: there are first surfaces.
layout(constant_id = 1) const uint HAS_FIRST = 0u;

layout(push_constant, scalar) uniform Push {
    uint emitter_count;
    uint sample_count;
    float density_scale;  // from a point's density among all lights to that among emissive triangles
} push;

// What a direction runs into.
vec3 light_of_direction(Receiver receiver, Scattering scattering, vec2 random) {
    vec3 local = sample_cosine_hemisphere(random);
    vec3 direction = to_world(scattering.frame, local);
    LobeValue lobe = diffuse_lobe(scattering.matter, scattering.viewer, local, 1.0);
    if (lobe.density <= 0.0 || max3(lobe.value) <= 0.0 || dot(receiver.surface.geometric_normal, direction) <= 0.0) {
        return vec3(0.0);
    }
    Hit hit = closest_hit(receiver.ray_origin, direction, 3e38);
    if (hit.triangle == NO_TRIANGLE) {
        return vec3(0.0);
    }
    return lobe.value / lobe.density * weighted_radiance(hit, direction, lobe.density, push.density_scale);
}

vec3 light_of_sample(Receiver receiver, Scattering scattering, vec4 random, bool is_first) {
    Emitter emitter = pick_emitter(emissive_triangles, push.emitter_count, random.x);
    Triangle triangle = load_triangle(triangles, emitter.number);
    Material material = load_material(materials, triangle.material);
    EmissivePoint point = draw_emissive_point(triangle, random.yz);
    vec3 front = front_normal(triangle);
    vec3 target = point_of_triangle(triangle, point.place, front);
    vec3 way = target - receiver.surface.position_rs;
    float distance2 = max(dot(way, way), 1e-30);
    vec3 to_light = way * inversesqrt(distance2);
    float cosine = -dot(front, to_light);
    cosine = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? abs(cosine) : cosine;
    vec3 direction = to_local(scattering.frame, to_light);
    if (min(cosine, min(direction.z, dot(receiver.surface.geometric_normal, to_light))) <= 0.0) {
        return vec3(0.0);
    }
    float density = point.density * push.density_scale * distance2 / max(cosine, 1e-9);
    LobeValue lobe = diffuse_lobe(scattering.matter, scattering.viewer, direction, 1.0);
    vec3 reflected = lobe.value * (is_first ? power_heuristic(density, lobe.density) : 1.0);
    if (!is_narrow(scattering.matter.alpha)) {
        reflected += reflection_lobe(scattering.matter, scattering.viewer, direction, 1.0).value;
    }
    vec3 light = reflected * covered_radiance(triangle, material, point.place) / density;
    if (max3(light) <= 0.0 || is_occluded(receiver.ray_origin, target - receiver.ray_origin, 1.0)) {
        return vec3(0.0);
    }
    return light;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (!is_listed(index)) {
        return;
    }
    Mirrored point = load_mirrored(mirrored_points, index);
    Receiver receiver = receiver_of(point);
    Scattering scattering = scattering_of(receiver);
    uint samples = samples_for(push.sample_count, max3(point.weight));
    // By the place: the order of the list differs from run to run.
    uvec3 bits = floatBitsToUint(point.surface.position_rs);
    uint seed = seed_of(mix_bits(bits.x ^ mix_bits(bits.y ^ mix_bits(bits.z))), 0u);
    bool is_first = HAS_FIRST != 0u && point.first;
    vec3 radiance = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < samples; ++i) {
        radiance += light_of_sample(receiver, scattering, sobol_sample(sobol, i, seed), is_first);
        if (is_first) {
            radiance += light_of_direction(receiver, scattering, sobol_sample(sobol, i, seed_of(seed, 1u)).xy);
        }
    }
    add_light(index, point.weight * radiance / float(samples));
}
