#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "particles/albedo.glsl"
#include "particles/home.glsl"
#include "particles/surface_points.glsl"

// Measures what particles stand for: each of many points spread evenly over the surfaces is counted at the particle that links find it by, with its
// albedo. So the area of a particle is that of its catchment, not an even share:
//
//   ΔA_i = A/M · |{m : home(x_m) = i}|,   ρ_i = mean of ρ(x_m) over these       (M points)

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer sums;
layout(set = 0, binding = 1) buffer Tallies { uint tallies[]; };  // count, red, green, blue of each
layout(set = 0, binding = 2) buffer Lost { uint lost[]; };

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint point_count;
} push;

const float ALBEDO_STEPS = 4095.0;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.point_count) {
        return;
    }
    SurfacePoint point = surface_point(sums, push.triangle_count, number, push.point_count, 2u);
    Material material = load_material(materials, point.triangle.material);
    if (ALPHA_MASKS != 0u && material.alpha_cutoff >= 0.0 && !is_covered(point.triangle, material, point.place)) {
        return;
    }
    float spacing = spacing_of_particles();
    vec3 start = offset_ray_origin(point.position, point.face);
    Hit above = closest_hit(start, point.normal, 2.0 * LIFT * spacing);
    float free = above.triangle == NO_TRIANGLE ? 3e38 : above.distance;
    uint home = home_of(point.position, point.normal, lifted(start, point.normal, point.normal, free, spacing));
    if (home == NO_PARTICLE) {
        atomicAdd(lost[0], 1u);
        return;
    }
    uvec3 albedo = uvec3(diffuse_albedo_at(point.triangle, material, point.place) * ALBEDO_STEPS + 0.5);
    atomicAdd(tallies[4u * home], 1u);
    atomicAdd(tallies[4u * home + 1u], albedo.r);
    atomicAdd(tallies[4u * home + 2u], albedo.g);
    atomicAdd(tallies[4u * home + 3u], albedo.b);
}
