// Points spread evenly over all diffuse surface: number i of n lies where the areas of the triangles, one after the other, add up to (i + ½)/n of
// all, and within a triangle on the points of the R₂ sequence (Roberts 2018), which fill it evenly for any number of them.
#ifndef PARTICLES_SURFACE_POINTS
#define PARTICLES_SURFACE_POINTS

#include "groups/scene_rays.glsl"
#include "lib/sobol.glsl"
#include "lib/traced_scene.glsl"
#include "particles/shading_normal.glsl"
#include "particles/sides.glsl"

struct SurfacePoint {
    Triangle triangle;
    uint index;
    vec2 place;     // weights of corners 1 and 2
    vec3 position;
    vec3 face;      // unit, on the point's side
    vec3 normal;    // of shading, likewise
};

// Area-preserving from the square, neighbours stay neighbours (Heitz 2019).
vec2 place_by_halves(vec2 square) {
    return square.y > square.x ? vec2(0.5 * square.x, square.y - 0.5 * square.x) : vec2(square.x - 0.5 * square.y, 0.5 * square.y);
}

// `sums`: the areas before each of `triangle_count` triangles, the total behind.
SurfacePoint surface_point(samplerBuffer sums, usamplerBuffer backs, uint triangle_count, uint number, uint count) {
    float total = texelFetch(sums, int(triangle_count)).x;
    float step_area = total / float(count);
    float area = (float(number) + 0.5) * step_area;
    uint low = 0u;
    uint high = triangle_count;
    [[dont_unroll]] for (uint halving = 0u; halving < 32u && high - low > 1u; ++halving) {
        uint middle = (low + high) / 2u;
        if (texelFetch(sums, int(middle)).x <= area) {
            low = middle;
        } else {
            high = middle;
        }
    }
    float first = texelFetch(sums, int(low)).x;
    float own = max(texelFetch(sums, int(low + 1u)).x - first, 1e-30);
    float along = clamp((area - first) / own, 0.0, 1.0);

    SurfacePoint point;
    point.index = low;
    point.triangle = load_triangle(triangles, low);
    bool both_sides = has_both_sides(backs, low, load_material(materials, point.triangle.material));
    bool back = both_sides && along >= 0.5;
    float side_area = both_sides ? 0.5 * own : own;
    // Numbers are counted from the first one of the side: areas are not exact enough for millions of points.
    float before = first + (back ? side_area : 0.0);
    uint k = number - uint(max(ceil(before / step_area - 0.5), 0.0));
    uint shift = seed_of(low * 2u + (back ? 1u : 0u), 1u);
    // In 32 bits: as a float the sequence would lose its spacing after some ten thousand points.
    uvec2 bits = uvec2(shift << 16, shift & 0xFFFF0000u) + k * uvec2(3242174889u, 2447445414u);
    point.place = place_by_halves(vec2(bits >> 8) / 16777216.0);

    vec3 front = front_normal(point.triangle);
    point.position = point_of_triangle(point.triangle, point.place, front);
    point.face = back ? -front : front;
    point.normal = shading_normal(point.triangle, point.place, point.face);
    return point;
}

#endif
