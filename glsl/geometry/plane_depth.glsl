// The depth that a triangle's plane has at a pixel's centre, exact where a rasteriser's is not.
//
// A rasteriser moves vertices to a grid of 2⁻ⁿ pixels, with no other depth than they had: its planes are off by up to their slope times that.
// Every device offers n = 4, where positions from such depths lie farther off their surface than what shadows and rays allow for.
//
// Triangles reach as far beyond their edges. A pixel that one covers by that alone shows a point behind whatever meets the triangle there, in the
// dark: such a point is put as deep as the edge is, and drawn towards the eye by BESIDE times as far as it is beside the triangle.
#ifndef GEOMETRY_PLANE_DEPTH
#define GEOMETRY_PLANE_DEPTH

#include "geometry/normals.glsl"
#include "lib/finite.glsl"

// Covers surfaces that meet the triangle and turn away from the eye by up to 75°.
const float BESIDE = 4.0;

vec3 put_inside(vec3 point, vec3 corner, vec3 edge, vec3 normal) {
    vec3 outwards = normalize_or(cross(edge, normal), vec3(0.0));
    return point - outwards * max(dot(outwards, point - corner), 0.0);
}

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
    vec3 point = from + held * ray;
    vec3 inside = put_inside(put_inside(put_inside(point, a, b - a, normal), b, c - b, normal), c, a - c, normal);
    vec3 aside = cross(point - inside, normalize(ray));
    float before = max(dot(inside - eye, forward) - BESIDE * length(aside), nearest);
    float depth = point == inside ? held : before;
    return is_finite(along) && along > 0.0 ? depth : rasterised;
}

#endif
