#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/mirrored.glsl"

// The same as mesh_homes.comp for one point that mirrors show.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Spots { uvec4 spots[]; };
layout(set = 0, binding = 1) readonly buffer Views { vec4 views[]; };
layout(set = 0, binding = 2) buffer Marks { uint marks[]; };
layout(set = 0, binding = 3) buffer Counts { uint counts[]; };
layout(set = 0, binding = 4) uniform usamplerBuffer subtriangle_marks;
layout(set = 0, binding = 5) uniform usamplerBuffer marked_before;

#include "particles/mesh_views.glsl"
#include "particles/seen_home.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Mirrored mirrored = load_mirrored(mirrored_points, index);
    Surface point = mirrored.surface;
    vec3 normal = point.geometric_normal;
    uvec4 spot = spots[index];
    uvec4 read = read_spot(spot, lifted(lift_of_point(point.position_rs, normal, mirrored.to_viewer, mirrored.ray_length), particle_spacing));
    if (read.x == NO_SPOT && max3(indirect_diffuse_albedo(point)) > 0.0) {
        read.y = seen_home(point.position_rs, normal, mirrored.to_viewer, mirrored.ray_length);
        atomicAdd(counts[1], 1u);
    }
    if (read != spot) {
        spots[index] = read;
    }
}
