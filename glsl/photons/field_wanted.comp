#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"

// If a list has points: how many groups of 64 take the photons that may light them. Without any nothing is made of these.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) buffer Arguments { uint arguments[]; };  // groups for each photon · a single one

layout(push_constant, scalar) uniform Push { uint groups; } push;

void main() {
    if (texelFetch(mirrored_count, 3).x > 0u) {
        arguments[0] = push.groups;
        arguments[1] = 1u;
        arguments[2] = 1u;
        arguments[3] = 1u;
        arguments[4] = 1u;
        arguments[5] = 1u;
    }
}
