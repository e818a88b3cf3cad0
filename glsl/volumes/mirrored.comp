#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "lib/mirrored.glsl"
#include "lib/ray_offset.glsl"
#include "caches/rays.glsl"

// The irradiance of one point that mirrors and glass show (lib/mirrored.glsl), from the caches around it (volumes/irradiance.glsl), W/m².

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer light;  // volumes/light.glsl
layout(set = 0, binding = 1) writeonly buffer ReceivedBlock { vec4 received[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    uint capacity;
} push;

#include "volumes/irradiance.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Surface point = load_mirrored(mirrored_points, index).surface;
    vec3 irradiance = vec3(0.0);
    if (max3(point.diffuse_albedo) > 0.0) {
        vec3 origin = WEIGHTS == WEIGHTS_RAYS ? offset_ray_origin(point.position_rs, point.geometric_normal) : vec3(0.0);
        precise vec3 position_rs = point.position_rs - push.rays.shift;
        uint absent;
        irradiance = irradiance_at(position_rs, point.normal, push.rays, origin, push.capacity, absent);
    }
    received[index] = vec4(irradiance, 0.0);
}
