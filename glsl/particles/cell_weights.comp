#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "lib/traced_scene.glsl"
#include "particles/cells.glsl"
#include "particles/link_direction.glsl"
#include "particles/sides.glsl"

// How densely particles are to lie on one cell, over where they lie least densely. Irradiance changes over a distance that is proportional to the harmonic mean
// distance of what is around (the split-sphere model of Ward et al. 1988),
//
//   1/R = 1/K Σ_k 1/d_k        (K rays around the middle of the cell, spread by the cosine; those that escape add 0)
//
// so that the particles' spacing follows R where R is less than NEAR_SPACINGS of them:
//
//   w = (NEAR_SPACINGS·s/R)², between 1 and MOST_DENSE        (s: the even spacing, m)

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer areas;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;  // first cell of each triangle
layout(set = 0, binding = 2) writeonly buffer Cells { uvec4 cells[]; };
layout(set = 0, binding = 3) uniform usamplerBuffer backs;

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint cell_room;
    float spacing;
} push;

const float NEAR_SPACINGS = 8.0;
const float MOST_DENSE = 4.0;
// Rays of a cell: what is smaller takes fewer, its neighbours have others.
const uint LEAST_SIDE = 2u;
const uint MOST_SIDE = 4u;
// Share of a cell's area from which on it takes the most.
const float WHOLE_CELL = 4.0;  // spacings²

float inverse_mean_distance(vec3 position, vec3 normal, uint cell, uint side) {
    vec3 origin = offset_ray_origin(position, normal);
    float sum = 0.0;
    [[dont_unroll]] for (uint ray = 0u; ray < side * side; ++ray) {
        Hit hit = closest_hit(origin, link_direction(cell, ray, side, normal), 3e38);
        sum += hit.triangle == NO_TRIANGLE ? 0.0 : 1.0 / max(hit.distance, 1e-30);
    }
    return sum / float(side * side);
}

void main() {
    uint cell = gl_GlobalInvocationID.x;
    if (cell >= push.cell_room) {
        return;
    }
    if (cell >= texelFetch(starts, int(push.triangle_count)).x) {
        cells[cell] = uvec4(0u);
        return;
    }
    uint low = 0u;
    uint high = push.triangle_count;
    [[dont_unroll]] for (uint halving = 0u; halving < 32u && high - low > 1u; ++halving) {
        uint middle = (low + high) / 2u;
        if (texelFetch(starts, int(middle)).x <= cell) {
            low = middle;
        } else {
            high = middle;
        }
    }
    uint first = texelFetch(starts, int(low)).x;
    uint part_count = texelFetch(starts, int(low + 1u)).x - first;
    uint parts = uint(sqrt(float(part_count)) + 0.5);
    float area = texelFetch(areas, int(low)).x / float(part_count);
    if (area <= 0.0) {
        cells[cell] = cell_record(0.0, low, cell - first, parts, INVERSE_WEIGHT_STEPS);
        return;
    }
    Triangle triangle = load_triangle(triangles, low);
    vec3 front = front_normal(triangle);
    vec3 position = point_of_triangle(triangle, place_of_part(vec2(1.0 / 3.0), cell - first, parts), front);
    uint side = area < WHOLE_CELL * push.spacing * push.spacing ? LEAST_SIDE : MOST_SIDE;
    float inverse = inverse_mean_distance(position, front, cell, side);
    if (has_both_sides(backs, low, load_material(materials, triangle.material))) {
        inverse = max(inverse, inverse_mean_distance(position, -front, cell, side));
    }
    float dense = NEAR_SPACINGS * push.spacing * inverse;
    float steps = float(INVERSE_WEIGHT_STEPS) / clamp(dense * dense, 1.0, MOST_DENSE);
    uint inverse_weight = uint(clamp(steps + 0.5, 1.0, float(INVERSE_WEIGHT_STEPS)));
    float weight = float(INVERSE_WEIGHT_STEPS) / float(inverse_weight);
    cells[cell] = cell_record(area * weight, low, cell - first, parts, inverse_weight);
}
