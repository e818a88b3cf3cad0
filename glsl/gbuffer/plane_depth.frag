#version 460
#include "lib/prelude.glsl"
#include "geometry/plane_depth.glsl"

// One pixel of the G-buffer: the depth of the surface that is seen there, by the plane of its triangle (geometry/plane_depth.glsl).

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 1) uniform usampler2D triangles;  // rg32ui, of each pixel

layout(push_constant, scalar) uniform Push { uvec2 size; } push;

layout(location = 2) flat in uvec2 drawn;

layout(location = 0) out float depth;  // r32f, reversed

void main() {
    vec2 ndc = gl_FragCoord.xy * (2.0 / vec2(push.size)) - 1.0;
    vec3 across = ndc.x * camera.right_scaled + ndc.y * camera.down_scaled;
    bool orthographic = camera.depth_range > 0.0;
    vec3 from = orthographic ? camera.position_rs + across : camera.position_rs;
    vec3 ray = orthographic ? camera.forward : camera.forward + across;
    float rasterised = orthographic ? camera.near + (1.0 - gl_FragCoord.z) * camera.depth_range : camera.near / gl_FragCoord.z;
    Sight sight = Sight(camera.position_rs, from, ray, camera.forward, camera.near);
    float z = distance_to_drawn(drawn, triangles, ivec2(0), ivec2(push.size), sight, rasterised);
    depth = orthographic ? 1.0 - (z - camera.near) / camera.depth_range : camera.near / z;
}
