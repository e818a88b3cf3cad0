#version 460
#include "lib/prelude.glsl"

// A fragment that survives the tests counts itself in its pixel's word: 1, and 100 more where `depth` is above a half.

layout(early_fragment_tests) in;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) buffer Hits { uint hits[]; };

layout(push_constant, scalar) uniform Push { uint width; } push;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint far = texelFetch(depth, pixel, 0).x > 0.5 ? 100u : 0u;
    atomicAdd(hits[uint(pixel.y) * push.width + uint(pixel.x)], 1u + far);
}
