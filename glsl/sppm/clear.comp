#version 460
#include "lib/prelude.glsl"

// Empties one queue: no group to dispatch, nothing queued.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) buffer QueueBlock { uint queue[]; };

void main() {
    queue[0] = 0u;
    queue[1] = 1u;
    queue[2] = 1u;
    queue[3] = 0u;
}
