// Points spread over all diffuse surface as closely as its cells say: number i of n lies where the weighted areas of the cells, one after the other, add up to
// (i + ½)/n of all, and within a cell on the points of the R₂ sequence (Roberts 2018), which fill it evenly for any number of them.
#ifndef PARTICLES_SURFACE_POINTS
#define PARTICLES_SURFACE_POINTS

#include "groups/scene_rays.glsl"
#include "lib/sobol.glsl"
#include "lib/traced_scene.glsl"
#include "particles/facets.glsl"
#include "particles/shading_normal.glsl"
#include "particles/widths.glsl"

struct SurfacePoint {
    Triangle triangle;
    uint index;
    uint width;     // of its cell (widths.glsl)
    vec2 place;     // weights of corners 1 and 2
    vec3 position;
    vec3 face;      // unit, on the point's side
    vec3 normal;    // of shading, likewise
};

// Area-preserving from the square, neighbours stay neighbours (Heitz 2019).
vec2 place_by_halves(vec2 square) {
    return square.y > square.x ? vec2(0.5 * square.x, square.y - 0.5 * square.x) : vec2(square.x - 0.5 * square.y, 0.5 * square.y);
}

// `sums`: the weighted areas before each cell, the total behind; `cells`, `weights`: of `triangle_count` triangles, of all cells (weights.comp).
SurfacePoint surface_point(samplerBuffer sums, usamplerBuffer cells, usamplerBuffer weights, uint triangle_count, uint number, uint count) {
    uint cell_count = texelFetch(cells, int(triangle_count)).x;
    float total = texelFetch(sums, int(cell_count)).x;
    float step_area = total / float(count);
    float area = (float(number) + 0.5) * step_area;
    uint low = 0u;
    uint high = cell_count;
    [[dont_unroll]] for (uint halving = 0u; halving < 32u && high - low > 1u; ++halving) {
        uint middle = (low + high) / 2u;
        if (texelFetch(sums, int(middle)).x <= area) {
            low = middle;
        } else {
            high = middle;
        }
    }
    // Numbers are counted from the first one of the cell: areas are not exact enough for millions of points.
    uint k = number - uint(max(ceil(texelFetch(sums, int(low)).x / step_area - 0.5), 0.0));

    SurfacePoint point;
    uint word = texelFetch(weights, int(low)).y;
    point.width = word & ~WHOLE_SIDE;
    point.index = record_of(cells, 0u, triangle_count, low);
    point.triangle = load_triangle(triangles, point.index);
    uvec2 record = texelFetch(cells, int(point.index)).xy;
    Cuts cuts = unpack_cuts(record.y);
    uint part = low - record.x;
    bool whole = (word & WHOLE_SIDE) != 0u;
    bool back = part >= cuts.columns * cuts.rows;
    uint shift = whole ? seed_of(point.index * 2u + (back ? 1u : 0u), 1u) : seed_of(low, 2u);
    // In 32 bits: as a float the sequence would lose its spacing after some ten thousand points.
    uvec2 bits = uvec2(shift << 16, shift & 0xFFFF0000u) + k * uvec2(3242174889u, 2447445414u);
    vec2 square = vec2(bits >> 8) / 16777216.0;
    point.place = whole ? place_by_halves(square) : even_place_in(part_of(WHOLE, cuts, part), cuts.apex, square);

    vec3 front = front_normal(point.triangle);
    point.position = point_of_triangle(point.triangle, point.place, front);
    point.face = back ? -front : front;
    point.normal = shading_normal(point.triangle, point.place, point.face);
    return point;
}

#endif
