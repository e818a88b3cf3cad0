#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "particles/again.glsl"
#include "particles/albedo.glsl"
#include "particles/home.glsl"
#include "particles/home_words.glsl"
#include "particles/surface_points.glsl"
#include "particles/tallies.glsl"

// Measures what particles stand for: each of many points spread evenly over the surfaces is counted at the particle that links find it by, with its
// albedo. So the area of a particle is that of its catchment, not an even share:
//
//   ΔA_i = A/M · |{m : home(x_m) = i}|,   ρ_i = mean of ρ(x_m) over these       (M points)
//
// and likewise of what broad specular lobes reflect, where there are any. Where something moved, the points that this may concern (touched_points.comp) are taken off the particles that stood for them, and counted again.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer sums;
layout(set = 0, binding = 1) buffer Tallies { uint tallies[]; };  // count, red, green, blue of each; broad lobes' red, green, blue, unused (tallies.glsl)
layout(set = 0, binding = 2) buffer Lost { uint lost[]; };
layout(set = 0, binding = 3) buffer Homes { uint homes[]; };      // of each point (home_words.glsl)
layout(set = 0, binding = 4) uniform usamplerBuffer head;
layout(set = 0, binding = 5) uniform usamplerBuffer again;
layout(set = 0, binding = 6) uniform usamplerBuffer backs;

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint point_count;
    uint again;           // 1: those points alone that are listed
} push;

void add_albedo(uint first, uvec3 albedo, uint once) {
    atomicAdd(tallies[first], albedo.r * once);
    atomicAdd(tallies[first + 1u], albedo.g * once);
    atomicAdd(tallies[first + 2u], albedo.b * once);
}

void count_point(uint home, uvec3 albedo, uvec3 broad, uint once) {
    uint first = 4u * tally_texels() * home;
    atomicAdd(tallies[first], once);
    add_albedo(first + 1u, albedo, once);
    if (BROAD_LOBES != 0u) {
        add_albedo(first + 4u, broad, once);
    }
}

void main() {
    uint number = push.again != 0u ? number_again(head, again, push.point_count) : gl_GlobalInvocationID.x;
    if (number >= push.point_count) {
        return;
    }
    SurfacePoint point = surface_point(sums, backs, push.triangle_count, number, push.point_count, 2u);
    Material material = load_material(materials, point.triangle.material);
    if (ALPHA_MASKS != 0u && material.alpha_cutoff >= 0.0 && !is_covered(point.triangle, material, point.place)) {
        homes[number] = NO_POINT;
        return;
    }
    float spacing = spacing_of_particles();
    vec3 start = offset_ray_origin(point.position, point.face);
    Hit above = closest_hit(start, point.normal, 2.0 * LIFT * spacing);
    float free = above.triangle == NO_TRIANGLE ? 3e38 : above.distance;
    uint home = home_of(point.position, point.normal, lifted(start, point.normal, point.normal, free, spacing));
    uvec3 albedo = uvec3(diffuse_albedo_at(point.triangle, material, point.place) * ALBEDO_STEPS + 0.5);
    uvec3 broad = uvec3(0u);
    if (BROAD_LOBES != 0u) {
        broad = uvec3(broad_albedo_at(point.triangle, material, point.place) * ALBEDO_STEPS + 0.5);
    }
    if (push.again != 0u && homes[number] < NO_POINT) {
        count_point(homes[number], albedo, broad, 0xFFFFFFFFu);
    }
    homes[number] = home == NO_PARTICLE ? LOST_POINT : home;
    if (home == NO_PARTICLE) {
        atomicAdd(lost[0], 1u);
        return;
    }
    count_point(home, albedo, broad, 1u);
}
