// The depth that a triangle's plane has at a pixel's centre, exact where a rasteriser's is not.
//
// A rasteriser moves vertices to a grid of 2⁻ⁿ pixels, with no other depth than they had: its planes are off by up to their slope times that.
// Every device offers n = 4, where positions from such depths lie farther off their surface than what shadows and rays allow for.
//
// Triangles reach as far beyond their edges. A pixel that one covers by that alone shows, at its centre, a triangle next to it: that of a pixel
// beside this one, where it passes near the edge. Of two that bend away from the eye the drawn one's plane lies before, and is taken, as its normal is;
// behind the other one the point would be in the dark. With nothing there it is put as deep as the edge is, and drawn towards the eye by BESIDE times as
// far as it is beside the triangle.
#ifndef GEOMETRY_PLANE_DEPTH
#define GEOMETRY_PLANE_DEPTH

#include "geometry/drawn_triangle.glsl"
#include "geometry/normals.glsl"
#include "lib/finite.glsl"

// Covers surfaces that meet the triangle and turn away from the eye by up to 75°.
const float BESIDE = 4.0;
// How far from the edge, over how far the point is beside it, what is seen there may be: beyond lies another surface, behind a silhouette.
const float NEAR_EDGE = 32.0;
// Of how far beside the triangle the point is: it stands so much before a surface that its own plane runs behind, to lie in its light.
const float BEFORE = 0.25;
// Of the largest coordinate: how much of a distance is rounding.
const float ROUNDING = 5e-7;

// A pixel's ray is from + z·ray, where z counts along the unit vector `forward` from `eye`; from `nearest` on, which is below 0 where `eye` is not where
// one looks from.
struct Sight {
    vec3 eye;
    vec3 from;
    vec3 ray;
    vec3 forward;
    float nearest;
};

struct Meeting {
    float along;   // how far the ray goes to the plane, within what the triangle spans
    float beside;  // how far from the triangle it meets it; 0 on it
    float edge;    // how far it would have to go to be as deep as the triangle's edge there
    bool met;      // not edge-on, nor behind the eye
};

vec3 put_inside(vec3 point, vec3 corner, vec3 edge, vec3 normal) {
    vec3 outwards = normalize_or(cross(edge, normal), vec3(0.0));
    return point - outwards * max(dot(outwards, point - corner), 0.0);
}

float largest(vec3 v) {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

Meeting meet(uvec2 triangle, Sight sight) {
    Instance instance = load_instance(instances, triangle.x);
    uvec3 corners = corners_of_triangle(instance, triangle.y);
    vec3 a = vec4(vertex_position(corners.x), 1.0) * instance.object_to_render;
    vec3 b = vec4(vertex_position(corners.y), 1.0) * instance.object_to_render;
    vec3 c = vec4(vertex_position(corners.z), 1.0) * instance.object_to_render;
    vec3 normal = normalize_or(cross(b - a, c - a), vec3(0.0));
    float along = dot(normal, a - sight.from) / dot(normal, sight.ray);
    vec3 spanned = vec3(dot(a - sight.eye, sight.forward), dot(b - sight.eye, sight.forward), dot(c - sight.eye, sight.forward));
    float farthest = max(spanned.x, max(spanned.y, spanned.z));
    float held = clamp(along, max(min(spanned.x, min(spanned.y, spanned.z)), sight.nearest), max(farthest, sight.nearest));
    vec3 point = sight.from + held * sight.ray;
    vec3 inside = put_inside(put_inside(put_inside(point, a, b - a, normal), b, c - b, normal), c, a - c, normal);
    float rounding = ROUNDING * max(max(largest(a), largest(b)), max(largest(c), largest(sight.eye)));
    float beside = max(length(cross(point - inside, normalize(sight.ray))) - rounding, 0.0);
    return Meeting(held, beside, dot(inside - sight.eye, sight.forward), is_finite(along) && along > min(sight.nearest, 0.0));
}

// `drawn`: instance and triangle of each pixel, those of the view within [low, high). `rasterised`: what to take where the triangle is seen edge-on.
float distance_to_drawn(uvec2 triangle, usampler2D drawn, ivec2 low, ivec2 high, Sight sight, float rasterised) {
    Meeting own = meet(triangle, sight);
    if (!own.met) {
        return rasterised;
    }
    if (own.beside == 0.0) {
        return own.along;
    }
    float reach = NEAR_EDGE * own.beside;
    float other = sight.nearest;
    bool found = false;
    for (int number = 0; number < 9; number++) {
        ivec2 pixel = clamp(ivec2(gl_FragCoord.xy) + ivec2(number % 3, number / 3) - 1, low, high - 1);
        uvec2 neighbour = texelFetch(drawn, pixel, 0).xy;
        if (neighbour != triangle && neighbour.x != NOTHING_DRAWN) {
            Meeting next = meet(neighbour, sight);
            float off = abs(next.along - own.edge);
            bool nearer = next.met && next.beside == 0.0 && off < reach;
            reach = nearer ? off : reach;
            other = nearer ? next.along : other;
            found = found || nearer;
        }
    }
    float before = max(own.edge - BESIDE * own.beside, sight.nearest);
    float beyond = max(own.along - other, 0.0);
    return !found ? before : max(min(own.along, other - min(BEFORE * own.beside, beyond)), sight.nearest);
}

#endif
