#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/mirrored.glsl"

// The particle that stands for one point that mirrors show (seen_home.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Homes { uint homes[]; };
layout(set = 0, binding = 1) buffer Marks { uint marks[]; };

#include "particles/seen_home.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Mirrored mirrored = load_mirrored(mirrored_points, index);
    Surface point = mirrored.surface;
    uint home = NO_PARTICLE;
    if (max3(indirect_diffuse_albedo(point)) > 0.0) {
        home = seen_home(point.position_rs, point.geometric_normal, mirrored.to_viewer, mirrored.ray_length);
    }
    homes[index] = home;
}
