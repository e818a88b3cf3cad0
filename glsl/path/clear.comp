#version 460
#include "lib/prelude.glsl"

// Empties all queues before a wave starts: no group to dispatch, nothing queued.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) buffer ActiveBlock { uint active_paths[]; };
layout(set = 0, binding = 1) buffer NextBlock { uint next_paths[]; };
layout(set = 0, binding = 2) buffer AliveBlock { uint alive_paths[]; };
layout(set = 0, binding = 3) buffer ConnectionBlock { uint connections[]; };

void main() {
    active_paths[0] = next_paths[0] = alive_paths[0] = connections[0] = 0u;
    active_paths[1] = next_paths[1] = alive_paths[1] = connections[1] = 1u;
    active_paths[2] = next_paths[2] = alive_paths[2] = connections[2] = 1u;
    active_paths[3] = next_paths[3] = alive_paths[3] = connections[3] = 0u;
}
