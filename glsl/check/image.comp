#version 460
#include "lib/prelude.glsl"
#include "lib/finite.glsl"

// Counts the texels of an image that are no numbers or, if asked for, below zero: radiance is neither.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1) buffer FaultBlock { uint faults[]; };

layout(push_constant, scalar) uniform Push {
    uvec2 size;
    uint word;      // of `faults`
    uint negative;  // 1: values below zero count
} push;

void main() {
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.size))) {
        return;
    }
    vec4 value = texelFetch(image, ivec2(gl_GlobalInvocationID.xy), 0);
    if (!is_finite(value) || (push.negative != 0u && any(lessThan(value.rgb, vec3(0.0))))) {
        atomicAdd(faults[push.word], 1u);
    }
}
