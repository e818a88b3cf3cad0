#version 460
#include "lib/prelude.glsl"

// One group sums the areas before each triangle, the total behind them, and from it the spacing √(A/N) of N particles.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform samplerBuffer areas;
layout(set = 0, binding = 1) writeonly buffer Sums { float sums[]; };
layout(set = 0, binding = 2) writeonly buffer Spacing { float spacing[]; };

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint particle_count;
} push;

#define SCAN_TYPE float

float scan_term(uint index) {
    return texelFetch(areas, int(index)).x;
}

void scan_store(uint index, float before) {
    sums[index] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.triangle_count);
    if (gl_LocalInvocationIndex == 0u) {
        spacing[0] = sqrt(max(scan_total() / float(push.particle_count), 1e-30));
    }
}
