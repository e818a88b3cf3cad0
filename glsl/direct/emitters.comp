#version 460
#include "lib/prelude.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "direct/receiver.glsl"
#include "lib/emitter_hits.glsl"
#include "lib/emitters.glsl"

// What emissive surfaces add to the slot `direct` of one pixel, estimated from points y of them, drawn by power:
//
//   L(x, v) ≈ 1/N Σ_k f(l_k, v) · (n·l_k)⁺ · L_e(y_k) · V / p_k        p = P(triangle) p(y) · d²/(n_y·−l)   [1/sr]
//
// `directions` finds the same light, as many times. Each lobe is weighted by the power heuristic (Veach & Guibas 1995).

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    uint emitter_count;
    uint sample_count;
    float density_scale;  // from a point's density among all lights to that among emissive triangles
} push;

vec3 light_of_sample(Receiver receiver, Scattering scattering, vec4 random) {
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
    LobeValue diffuse_part = diffuse_lobe(scattering.matter, scattering.viewer, direction, scattering.shares.x);
    LobeValue specular_part = specular_lobe(scattering.matter, scattering.viewer, direction, scattering.shares);
    float density = point.density * push.density_scale * distance2 / max(cosine, 1e-9);
    vec3 reflected = diffuse_part.value * power_heuristic(density, diffuse_part.density)
                     + specular_part.value * power_heuristic(density, specular_part.density);
    vec3 light = reflected * covered_radiance(triangle, material, point.place) / density;
    if (max3(light) <= 0.0 || is_occluded(receiver.ray_origin, target - receiver.ray_origin, 1.0)) {
        return vec3(0.0);
    }
    return light;
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(direct);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec3 radiance = vec3(0.0);
    if (pixel_depth > 0.0) {
        Receiver receiver = load_receiver(pixel, size, pixel_depth, push.shift);
        Scattering scattering = scattering_of(receiver);
        uint seed = seed_of(seed_of_pixel(pixel), 0u);
        [[dont_unroll]] for (uint i = 0u; i < push.sample_count; ++i) {
            radiance += light_of_sample(receiver, scattering, sobol_sample(sobol, i, seed));
        }
    }
    store_direct(pixel, radiance / float(push.sample_count));
}
