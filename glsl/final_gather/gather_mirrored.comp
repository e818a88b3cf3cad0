#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "groups/photon_map.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/mirrored.glsl"
#include "lib/ray_offset.glsl"

// The irradiance of indirect light at one point that mirrors show (lib/mirrored.glsl) by gather rays, some of them in each pass, W/m².

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Received { vec4 received[]; };

layout(push_constant, scalar) uniform Push { GatherRays rays; } push;

#include "final_gather/incoming.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Surface point = load_mirrored(mirrored_points, index).surface;
    vec3 irradiance = push.rays.first > 0u ? received[index].rgb : vec3(0.0);
    if (max3(point.diffuse_albedo) > 0.0) {
        uvec3 bits = floatBitsToUint(point.position_rs);
        uint seed = mix_bits(bits.x ^ mix_bits(bits.y ^ mix_bits(bits.z)));
        vec3 origin = offset_ray_origin(point.position_rs, point.geometric_normal);
        irradiance += irradiance_by_rays(origin, point.normal, point.geometric_normal, seed);
    }
    received[index] = vec4(irradiance, 0.0);
}
