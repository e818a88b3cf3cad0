#version 460
#include "lib/prelude.glsl"

// One group sums the flux that all particles received from lights, in a fixed order, and from the sum takes the step of the fixed-point numbers that scattered flux is
// added up in. No surface reflects more than it receives, so that what all particles together receive in one bounce stays below 2³¹ steps.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform samplerBuffer flux;
layout(set = 0, binding = 1) writeonly buffer Scale { vec4 scale[]; };  // steps a watt; the sum in W

layout(push_constant, scalar) uniform Push { uint flux_count; } push;

#define SCAN_TYPE vec4

vec4 scan_term(uint index) {
    return texelFetch(flux, int(index));
}

void scan_store(uint index, vec4 before) {
}

#include "lib/prefix_scan.glsl"

void main() {
    scan_sum_before_run(push.flux_count);
    if (gl_LocalInvocationIndex == 0u) {
        vec3 total = scan_total().rgb;
        float most = max(total.r, max(total.g, total.b));
        scale[0] = vec4(most > 0.0 ? 2147483648.0 / most : 0.0, total);
    }
}
