#version 460
#include "lib/prelude.glsl"
#include "hemicube/weight.glsl"

// What one texel receives of what its view shows (Larsen & Christensen 2004, equation 3, which lacks the π of radiances), W/m²:
//
//   E = π Σ L·F / ΣF
//
// The sum below counts what the plane leaves out as if it were like the mean of the rest.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer list;   // texels to gather
layout(set = 0, binding = 1) uniform usamplerBuffer head;   // word 3: how many
layout(set = 0, binding = 2) uniform samplerBuffer light;   // by view, row by row
layout(set = 0, binding = 3) buffer Gathered { vec4 gathered[]; };  // by map and texel; w: rounds, of which there is one

layout(push_constant, scalar) uniform Push {
    uint first;       // place in the list of this batch's first view
    uint view_count;  // of the batch
    uint side;        // fragments
    float plane;      // a
    float covered;    // ΣF
    uint first_of_map;  // element of `gathered`
} push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.view_count || push.first + number >= texelFetch(head, 3).x) {
        return;
    }
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint y = 0u; y < push.side; ++y) {
        [[dont_unroll]] for (uint x = 0u; x < push.side; ++x) {
            uint place = (number * push.side + y) * push.side + x;
            sum += weight_of(uvec2(x, y), push.side, push.plane) * texelFetch(light, int(place)).rgb;
        }
    }
    gathered[push.first_of_map + texelFetch(list, int(push.first + number)).x] = vec4(sum * (PI / push.covered), 1.0);
}
