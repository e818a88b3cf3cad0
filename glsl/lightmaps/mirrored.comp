#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/mirrored.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/mirrored.glsl"
#include "lightmaps/seen.glsl"

// The irradiance of diffuse light at one point that mirrors show, W/m², as pixels have it (pixels.comp).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Received { vec4 received[]; };
layout(set = 0, binding = 1) uniform samplerBuffer gathered;   // the IIM

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Mirrored mirrored = load_mirrored(mirrored_points, index);
    Surface point = mirrored.surface;
    vec3 irradiance = vec3(0.0);
    if (max3(indirect_diffuse_albedo(point)) > 0.0) {
        irradiance = seen_irradiance(point.position_rs, point.geometric_normal, mirrored.to_viewer, mirrored.ray_length, gathered);
    }
    received[index] = vec4(irradiance, 1.0);
}
