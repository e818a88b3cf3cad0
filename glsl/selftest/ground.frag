#version 460
#include "lib/prelude.glsl"

// Counts the fragments of each pixel.

layout(set = 0, binding = 0) buffer Hits { uint hits[]; };

layout(push_constant, scalar) uniform Push {
    float reach;
    float side;
    uint width;
} push;

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    atomicAdd(hits[pixel.y * push.width + pixel.x], 1u);
}
