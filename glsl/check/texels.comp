#version 460
#include "lib/prelude.glsl"
#include "lib/finite.glsl"

// Counts the texels of a buffer of floats that are no numbers.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer texels;
layout(set = 0, binding = 1) buffer FaultBlock { uint faults[]; };

layout(push_constant, scalar) uniform Push {
    uint count;
    uint word;  // of `faults`
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < push.count && !is_finite(texelFetch(texels, int(index)))) {
        atomicAdd(faults[push.word], 1u);
    }
}
