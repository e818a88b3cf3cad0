#version 460
#include "lib/prelude.glsl"
#include "geometry/plane_depth.glsl"
#include "light_views/view.glsl"

// One texel of a light view: the depth of the surface that is seen there, by the plane of its triangle (geometry/plane_depth.glsl).

layout(location = 2) flat in uvec2 drawn;

layout(location = 0) out float depth;  // r32f, reversed

void main() {
    LightView view = load_view(views, push.view_index);
    vec2 tangent = tangent_of_texel(view, gl_FragCoord.xy);
    bool orthographic = is_orthographic(view);
    // An orthographic view counts from its far plane, below 0 towards the light; here from its near one.
    vec3 eye = orthographic ? view.origin_rs - view.forward * view.depth_range : view.origin_rs;
    vec3 from = orthographic ? eye + tangent.x * view.right + tangent.y * view.down : eye;
    float z = distance_to_triangle(
        drawn, eye, from, ray_of_tangent(view, tangent), view.forward, orthographic ? 0.0 : view.near,
        depth_from_light(view, gl_FragCoord.z));
    depth = orthographic ? 1.0 - z / view.depth_range : view.near / z;
}
