#version 460
#include "lib/prelude.glsl"
#include "particles/facets.glsl"

// One group cuts all triangles into cells of a size (facets.glsl), of a larger one where thin triangles would take more than there is room for.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform samplerBuffer sizes;
layout(set = 0, binding = 1) writeonly buffer Cells { uint cells[]; };  // two words of each triangle, and behind those of all

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint room;
    float size;       // m
} push;

const float LARGER = 1.25;
const uint ATTEMPTS = 40u;

shared float size;

Cuts cuts_of_triangle(uint index) {
    vec4 triangle = texelFetch(sizes, int(index));
    return triangle.w > 0.0 ? cuts_of(triangle.xy, size, uint(triangle.z), uint(triangle.w), 0u) : Cuts(0u, 0u, 0u, 1u, 0u);
}

#define SCAN_TYPE uint

uint scan_term(uint index) {
    return parts_of(cuts_of_triangle(index));
}

void scan_store(uint index, uint before) {
    cells[2u * index] = before;
    cells[2u * index + 1u] = index < push.triangle_count ? pack_cuts(cuts_of_triangle(index)) : 0u;
}

#include "lib/prefix_scan.glsl"

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        size = push.size;
    }
    barrier();
    uint before = scan_sum_before_run(push.triangle_count);
    [[dont_unroll]] for (uint attempt = 0u; attempt < ATTEMPTS && scan_total() > push.room; ++attempt) {
        barrier();
        if (gl_LocalInvocationIndex == 0u) {
            size *= LARGER;
        }
        barrier();
        before = scan_sum_before_run(push.triangle_count);
    }
    scan_store_run(push.triangle_count, before);
    if (gl_LocalInvocationIndex == 0u) {
        scan_store(push.triangle_count, scan_total());
    }
}
