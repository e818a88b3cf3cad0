#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/mirrored.glsl"
#include "particles/home.glsl"

// The particle that stands for one point that mirrors show, by the rule of pixels (homes.comp); it is marked as used.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Homes { uint homes[]; };
layout(set = 0, binding = 1) buffer Marks { uint marks[]; };

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Mirrored mirrored = load_mirrored(mirrored_points, index);
    Surface point = mirrored.surface;
    uint home = NO_PARTICLE;
    if (max3(indirect_diffuse_albedo(point)) > 0.0) {
        vec3 from = lifted(point.position_rs, point.geometric_normal, mirrored.to_viewer, mirrored.ray_length, spacing_of_particles());
        home = home_of(point.position_rs, point.geometric_normal, from);
        if (home == NO_PARTICLE) {
            home = home_among(point.position_rs, point.geometric_normal, from, NOT_OPPOSITE, false);
        }
    }
    if (home != NO_PARTICLE) {
        atomicOr(marks[home], 1u);
    }
    homes[index] = home;
}
