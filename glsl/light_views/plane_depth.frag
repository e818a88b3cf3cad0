#version 460
#include "lib/prelude.glsl"
#include "geometry/plane_depth.glsl"
#include "light_views/view.glsl"

// One texel of a light view: the depth of the surface that is seen there, by the plane of its triangle (geometry/plane_depth.glsl).

layout(set = 0, binding = 0) uniform usampler2D triangles;  // rg32ui, of each texel

layout(location = 2) flat in uvec2 drawn;

layout(location = 0) out float depth;  // r32f, reversed

void main() {
    LightView view = load_view(views, push.view_index);
    vec2 tangent = tangent_of_texel(view, gl_FragCoord.xy);
    bool orthographic = is_orthographic(view);
    // An orthographic view counts from its far plane, below 0 towards the light, where depths are at their finest.
    vec3 from = is_orthographic(view) ? view.origin_rs + tangent.x * view.right + tangent.y * view.down : view.origin_rs;
    Sight sight = Sight(
        view.origin_rs, from, ray_of_tangent(view, tangent), view.forward, by_kind(view, -view.depth_range, view.near));
    depth = depth_of_linear(view, distance_to_drawn(
        drawn, triangles, view.rect_origin, view.rect_origin + view.rect_size, sight, linear_depth(view, gl_FragCoord.z)));
}
