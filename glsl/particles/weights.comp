#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "lib/traced_scene.glsl"
#include "particles/facets.glsl"
#include "particles/link_direction.glsl"
#include "particles/sides.glsl"
#include "particles/widths.glsl"

// How far apart particles are to lie on one cell of a triangle. Irradiance E changes over a distance that is proportional to the harmonic mean distance R of what is
// around (the split-sphere model of Ward et al. 1988),
//
//   1/R = 1/K Σ_k 1/d_k        (K rays spread by the cosine; those that escape add 0)
//
// and what is interpolated between points that are s apart is off by (s/R)²·E to the second order. So many points have the least squared error in sum if s ~ R^⅔:
// ∫ (s/R)⁴ + λ/s² dA is least where s⁶ ~ R⁴. That is followed where R is larger than `nearest`, up to 8 times the spacing: closer to each other particles are not more
// exact, since what is left is noise of their links. Nothing is to be seen of what lies within other things, or against them: there they are as far apart as they may be.

layout(local_size_x = 64) in;

// 0: particles lie evenly.
layout(constant_id = 0) const uint ADAPTIVE = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer areas;
layout(set = 0, binding = 1) uniform usamplerBuffer cells;
layout(set = 0, binding = 2) writeonly buffer Weights { uvec2 weights[]; };  // of cells (widths.glsl)
layout(set = 0, binding = 3) uniform usamplerBuffer backs;

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint room;          // of cells
    float spacing;      // if particles lay evenly, m
    float nearest;      // R up to which they lie closest, m
} push;

// Even spacings: a hit that is nearer than this is something that lies against the surface.
const float AGAINST = 0.01;
// Points of a cell a side, and rays of each of these a side; a cell as small as a particle's square has one point.
const uint POINTS_SIDE = 2u;
const uint MOST_SIDE = 4u;
const uint LEAST_SIDE = 2u;

// 1/R at a point, or less than 0 if it is buried.
float inverse_mean_distance(vec3 position, vec3 normal, uint seed, uint side) {
    vec3 origin = offset_ray_origin(position, normal);
    float sum = 0.0;
    uint buried = 0u;
    [[dont_unroll]] for (uint ray = 0u; ray < side * side; ++ray) {
        vec3 direction = link_direction(seed, ray, side, normal);
        Hit hit = closest_hit(origin, direction, 3e38);
        if (hit.triangle == NO_TRIANGLE) {
            continue;
        }
        Triangle triangle = load_triangle(triangles, hit.triangle);
        bool from_back = dot(front_normal(triangle), direction) > 0.0 && !has_both_sides(backs, hit.triangle, load_material(materials, triangle.material));
        buried += from_back || hit.distance < AGAINST * push.spacing ? 1u : 0u;
        sum += 1.0 / max(hit.distance, 1e-30);
    }
    return 2u * buried > side * side ? -1.0 : sum / float(side * side);
}

void main() {
    uint cell = gl_GlobalInvocationID.x;
    if (cell >= push.room) {
        return;
    }
    if (cell >= texelFetch(cells, int(push.triangle_count)).x) {
        weights[cell] = uvec2(0u);
        return;
    }
    uint index = record_of(cells, 0u, push.triangle_count, cell);
    uvec2 record = texelFetch(cells, int(index)).xy;
    Cuts cuts = unpack_cuts(record.y);
    Span span = part_of(WHOLE, cuts, cell - record.x);
    float area = texelFetch(areas, int(index)).x / float(cuts.sides) * share_of(span);
    uint width = 0u;
    if (ADAPTIVE != 0u) {
        Triangle triangle = load_triangle(triangles, index);
        vec3 front = front_normal(triangle);
        vec3 face = cell - record.x >= cuts.columns * cuts.rows ? -front : front;
        float square = push.spacing * push.spacing;
        uint points_side = area > square ? POINTS_SIDE : 1u;
        uint side = area > 0.25 * square ? MOST_SIDE : LEAST_SIDE;
        float inverse = -1.0;
        [[dont_unroll]] for (uint point = 0u; point < points_side * points_side; ++point) {
            vec2 at = (vec2(point % points_side, point / points_side) + 0.5) / float(points_side);
            vec3 position = point_of_triangle(triangle, even_place_in(span, cuts.apex, at), front);
            inverse = max(inverse, inverse_mean_distance(position, face, POINTS_SIDE * POINTS_SIDE * cell + point, side));
        }
        float distances = 1.0 / max(push.nearest * inverse, 1e-30);
        width = inverse < 0.0 ? MOST_WIDTH : width_of_spacing(pow(min(distances, 1e20), 2.0 / 3.0));
    }
    float spacing = spacing_of_width(width);
    weights[cell] = uvec2(floatBitsToUint(area / (spacing * spacing)), width);
}
