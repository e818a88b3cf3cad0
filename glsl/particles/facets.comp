#version 460
#include "lib/prelude.glsl"
#include "particles/facets.glsl"
#include "particles/widths.glsl"

// One group cuts all cells into facets of a size of at most a third of their particles' spacing, a quarter where triangles are many cells, so that some 16 lie around
// a particle: rows of triangles become ever shorter, those of cells less so. Where thin triangles take too many, they have a larger size, for which there is room.

layout(local_size_x = 256) in;

// 1: particles do not lie evenly.
layout(constant_id = 0) const uint ADAPTIVE = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer sizes;
layout(set = 0, binding = 1) uniform samplerBuffer spacing;
layout(set = 0, binding = 2) writeonly buffer Facets { uint facets[]; };  // records of triangles and of cells (facets.glsl)
layout(set = 0, binding = 3) writeonly buffer FacetSize { float facet_size[]; };  // m
layout(set = 0, binding = 4) uniform usamplerBuffer cells;
layout(set = 0, binding = 5) uniform usamplerBuffer weights;

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint room;
} push;

const float FACETS_A_SPACING = 3.0;
const float FACETS_OF_CELLS = 4.0;
const float LARGER = 1.25;
const uint ATTEMPTS = 40u;
// The size by which areas are counted (tallies.glsl), over the smallest one: that of half the largest.
const float COUNTED = 4.0;

shared float size;

Cuts cuts_of_cell(uint cell) {
    uint index = record_of(cells, 0u, push.triangle_count, cell);
    uvec2 record = texelFetch(cells, int(index)).xy;
    Cuts cuts = unpack_cuts(record.y);
    uint width = texelFetch(weights, int(cell)).y & ~WHOLE_SIDE;
    vec2 extent = extent_of(part_of(WHOLE, cuts, cell - record.x), texelFetch(sizes, int(index)).xy);
    return cuts_of(extent, size * spacing_of_width(width), cuts.apex, 1u, width);
}

#define SCAN_TYPE uint

uint scan_term(uint cell) {
    return parts_of(cuts_of_cell(cell));
}

void scan_store(uint cell, uint before) {
    uint word = 2u * (push.triangle_count + 1u + cell);
    facets[word] = before;
    facets[word + 1u] = pack_cuts(cuts_of_cell(cell));
}

#include "lib/prefix_scan.glsl"

void main() {
    uint cell_count = texelFetch(cells, int(push.triangle_count)).x;
    if (gl_LocalInvocationIndex == 0u) {
        size = texelFetch(spacing, 0).x / (ADAPTIVE != 0u ? FACETS_OF_CELLS : FACETS_A_SPACING);
    }
    barrier();
    uint before = scan_sum_before_run(cell_count);
    [[dont_unroll]] for (uint attempt = 0u; attempt < ATTEMPTS && scan_total() > push.room; ++attempt) {
        barrier();
        if (gl_LocalInvocationIndex == 0u) {
            size *= LARGER;
        }
        barrier();
        before = scan_sum_before_run(cell_count);
    }
    scan_store_run(cell_count, before);
    [[dont_unroll]] for (uint index = gl_LocalInvocationIndex; index < push.triangle_count; index += gl_WorkGroupSize.x) {
        uvec2 record = texelFetch(cells, int(index)).xy;
        facets[2u * index] = push.triangle_count + 1u + record.x;
        facets[2u * index + 1u] = record.y;
    }
    if (gl_LocalInvocationIndex == 0u) {
        facets[2u * push.triangle_count] = scan_total();
        facets[2u * push.triangle_count + 1u] = cell_count;
        facet_size[0] = size * (ADAPTIVE != 0u ? COUNTED : 1.0);
    }
}
