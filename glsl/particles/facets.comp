#version 460
#include "lib/prelude.glsl"
#include "particles/facets.glsl"

// One group cuts all triangles into facets of a size of at most a third of the particles' spacing, so that some 16 lie around a particle; where thin triangles take
// too many, of a larger size, for which there is room.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform samplerBuffer sizes;
layout(set = 0, binding = 1) uniform samplerBuffer spacing;
layout(set = 0, binding = 2) writeonly buffer Facets { uint facets[]; };  // two words each (facets.glsl)
layout(set = 0, binding = 3) writeonly buffer FacetSize { float facet_size[]; };  // m

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint room;
} push;

const float FACETS_A_SPACING = 3.0;
const float LARGER = 1.25;
const uint ATTEMPTS = 40u;

shared float size;

Cuts cuts_of(vec4 triangle, float length) {
    if (triangle.w <= 0.0) {
        return Cuts(0u, 0u, 0u, 1u);
    }
    uvec2 cuts = uvec2(clamp(ceil(triangle.xy / length), vec2(1.0), vec2(MOST_CUTS)));
    return Cuts(cuts.x, cuts.y, uint(triangle.z), uint(triangle.w));
}

#define SCAN_TYPE uint

uint scan_term(uint index) {
    return facets_of(cuts_of(texelFetch(sizes, int(index)), size));
}

void scan_store(uint index, uint before) {
    facets[2u * index] = before;
    facets[2u * index + 1u] = index < push.triangle_count ? pack_cuts(cuts_of(texelFetch(sizes, int(index)), size)) : 0u;
}

#include "lib/prefix_scan.glsl"

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        size = texelFetch(spacing, 0).x / FACETS_A_SPACING;
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
        facet_size[0] = size;
    }
}
