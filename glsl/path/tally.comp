#version 460
#include "lib/prelude.glsl"

// Ends the step of a wave by one vertex: counts its rays, says how many paths go on, and empties the queues that it used.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) buffer ActiveBlock { uint active_paths[]; };
layout(set = 0, binding = 1) buffer AliveBlock { uint alive_paths[]; };
layout(set = 0, binding = 2) buffer ConnectionBlock { uint connections[]; };
layout(set = 0, binding = 3) uniform usamplerBuffer next_paths;
// Rays of this submission, paths that go on.
layout(set = 0, binding = 4) buffer TotalBlock { uint totals[]; };

void main() {
    totals[0] += active_paths[3] + connections[3];
    totals[1] = texelFetch(next_paths, 3).x;
    active_paths[0] = alive_paths[0] = connections[0] = 0u;
    active_paths[3] = alive_paths[3] = connections[3] = 0u;
}
