#version 460
#include "lib/prelude.glsl"

// Every invocation counts itself.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Counters { uint counters[]; };

void main() {
    atomicAdd(counters[0], 1u);
}
