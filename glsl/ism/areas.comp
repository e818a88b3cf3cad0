#version 460
#include "lib/prelude.glsl"
#include "ism/triangles.glsl"

// One group sums the areas [m²] of a block of 256 triangles: area_sums[t] is the area of the block's triangles up to t, itself included
// (Hillis & Steele 1986); block_areas[b] that of the block. Fixed order: the same bits every time.

layout(local_size_x = 256) in;

layout(set = 0, binding = 1) writeonly buffer AreaSums { float area_sums[]; };
layout(set = 0, binding = 2) writeonly buffer BlockAreas { float block_areas[]; };

layout(push_constant, scalar) uniform Push {
    uint instance_count;
    uint triangle_count;
    uint block_count;
    float reach;      // m, around the middle of the scene
    vec3 middle_rs;
} push;

shared float sums[BLOCK_TRIANGLES];

void main() {
    uint self = gl_LocalInvocationIndex;
    for (uint block = gl_WorkGroupID.x; block < push.block_count; block += gl_NumWorkGroups.x) {
        uint triangle = block * BLOCK_TRIANGLES + self;
        float area = 0.0;
        if (triangle < push.triangle_count) {
            mat3 edges = corner_and_edges(triangle, push.instance_count);
            // What is farther away than all that matters gets no points.
            vec3 middle = edges[0] + (edges[1] + edges[2]) / 3.0;
            float radius = max(length(edges[0] - middle), max(length(edges[0] + edges[1] - middle), length(edges[0] + edges[2] - middle)));
            area = distance(middle, push.middle_rs) - radius <= push.reach ? 0.5 * length(cross(edges[1], edges[2])) : 0.0;
        }
        sums[self] = area;
        barrier();
        [[dont_unroll]] for (uint stride = 1u; stride < BLOCK_TRIANGLES; stride *= 2u) {
            float lower = self >= stride ? sums[self - stride] : 0.0;
            barrier();
            sums[self] += lower;
            barrier();
        }
        if (triangle < push.triangle_count) {
            area_sums[triangle] = sums[self];
        }
        if (self == BLOCK_TRIANGLES - 1u) {
            block_areas[block] = sums[self];
        }
        barrier();
    }
}
