#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/mirrored.glsl"

// The subtriangle at one point that mirrors show (mesh_seen.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Spots { uvec4 spots[]; };
layout(set = 0, binding = 1) buffer Marks { uint marks[]; };
layout(set = 0, binding = 2) uniform usamplerBuffer tessellation;

#include "particles/mesh_seen.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Mirrored mirrored = load_mirrored(mirrored_points, index);
    Surface point = mirrored.surface;
    uvec4 spot = NOTHING_SEEN;
    if (max3(indirect_diffuse_albedo(point)) > 0.0) {
        spot = seen_subtriangle(point.position_rs, point.geometric_normal, mirrored.to_viewer, mirrored.ray_length);
    }
    spots[index] = spot;
}
