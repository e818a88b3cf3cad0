#version 460
#include "lib/prelude.glsl"
#include "ism/triangles.glsl"
#include "lib/octahedral.glsl"

// One invocation places one of the points that stand for the scene's surfaces in imperfect shadow maps (Ritschel et al. 2008), by area.
// A set of n points takes n equal shares of the area in the triangles' order, one point each; inside their triangles the points of a set
// follow the additive recurrence of the plastic number, which covers the unit square evenly (Roberts 2018, R₂). Sets are shifted against each
// other in both. A point holds its position and the triangle's normal, or 0 if the scene has no area.

layout(local_size_x = 64) in;

layout(set = 0, binding = 1) uniform samplerBuffer area_sums;
layout(set = 0, binding = 2) uniform samplerBuffer area_before;
layout(set = 0, binding = 3) writeonly buffer Points { vec4 points[]; };

layout(push_constant, scalar) uniform Push {
    uint instance_count;
    uint triangle_count;
    uint block_count;
    uint points_of_set;
    uint set_count;
} push;

// 2³²/p and 2³²/p², p = 1.3247… the real root of p³ = p + 1.
const uvec2 PLASTIC_STEP = uvec2(3242174889u, 2447445414u);
// 2³²/φ: shifts of the sets.
const uint GOLDEN_STEP = 2654435769u;

float unit_float(uint bits) {
    return float(bits >> 8) * (1.0 / 16777216.0);
}

// The triangle at which the sum of areas passes `target`.
uint find_triangle(float target) {
    int low = 0;
    int high = int(push.block_count);
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (texelFetch(area_before, middle).x <= target) {
            low = middle;
        } else {
            high = middle;
        }
    }
    float inside = target - texelFetch(area_before, low).x;
    int first = low * int(BLOCK_TRIANGLES);
    int last = min(first + int(BLOCK_TRIANGLES), int(push.triangle_count)) - 1;
    while (first < last) {
        int middle = (first + last) / 2;
        if (texelFetch(area_sums, middle).x > inside) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    return uint(first);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.points_of_set * push.set_count) {
        return;
    }
    float total = texelFetch(area_before, int(push.block_count)).x;
    if (total <= 0.0) {
        points[index] = vec4(0.0);
        return;
    }
    uint set = index / push.points_of_set;
    uint number = index % push.points_of_set;
    float along = unit_float(set * GOLDEN_STEP + 0x80000000u);
    uint triangle = find_triangle(total * ((float(number) + along) / float(push.points_of_set)));
    uvec2 place = number * PLASTIC_STEP + set * uvec2(GOLDEN_STEP, 0x632BE59Bu);
    vec2 square = vec2(unit_float(place.x), unit_float(place.y));
    // Folded along the diagonal: area is kept.
    vec2 weights = square.x + square.y > 1.0 ? 1.0 - square : square;
    mat3 edges = corner_and_edges(triangle, push.instance_count);
    vec3 position_rs = edges[0] + weights.x * edges[1] + weights.y * edges[2];
    vec3 normal = normalize_or(cross(edges[1], edges[2]), vec3(0.0, 0.0, 1.0));
    points[index] = vec4(position_rs, pack_direction_in_float(normal));
}
