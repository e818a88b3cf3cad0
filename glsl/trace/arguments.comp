#version 460
#include "lib/prelude.glsl"

// How many groups of 64 take the listed points, those for which there was room.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) writeonly buffer Arguments { uint arguments[]; };  // groups, number of points

layout(push_constant, scalar) uniform Push { uint capacity; } push;

void main() {
    uint count = min(texelFetch(counts, 0).x, push.capacity);
    arguments[0] = (count + 63u) / 64u;
    arguments[1] = 1u;
    arguments[2] = 1u;
    arguments[3] = count;
}
