// The depth that a triangle's plane has at a pixel's centre, exact where a rasteriser's is not.
//
// A rasteriser moves vertices to a grid of 2⁻ⁿ pixels, with no other depth than they had: its planes are off by up to their slope times that.
// Every device offers n = 4, where positions from such depths lie farther off their surface than what shadows and rays allow for.
#ifndef GEOMETRY_PLANE_DEPTH
#define GEOMETRY_PLANE_DEPTH

#include "geometry/normals.glsl"
#include "lib/finite.glsl"

// How far `from` + z·`ray` goes to the plane of the triangle, where z counts along the unit vector `forward` from `eye`; within what the triangle
// spans, since its pixels may reach beyond it. `rasterised`: what to take where the triangle is seen edge-on.
float distance_to_triangle(uvec2 drawn, vec3 eye, vec3 from, vec3 ray, vec3 forward, float nearest, float rasterised) {
    Instance instance = load_instance(instances, drawn.x);
    uvec3 corners = corners_of_triangle(instance, drawn.y);
    vec3 a = vec4(vertex_position(corners.x), 1.0) * instance.object_to_render;
    vec3 b = vec4(vertex_position(corners.y), 1.0) * instance.object_to_render;
    vec3 c = vec4(vertex_position(corners.z), 1.0) * instance.object_to_render;
    vec3 normal = normalize_or(cross(b - a, c - a), vec3(0.0));
    float along = dot(normal, a - from) / dot(normal, ray);
    vec3 spanned = vec3(dot(a - eye, forward), dot(b - eye, forward), dot(c - eye, forward));
    float farthest = max(spanned.x, max(spanned.y, spanned.z));
    float held = clamp(along, max(min(spanned.x, min(spanned.y, spanned.z)), nearest), max(farthest, nearest));
    return is_finite(along) && along > 0.0 ? held : rasterised;
}

#endif
