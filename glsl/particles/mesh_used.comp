#version 460
#include "lib/prelude.glsl"

// Marks the area particles in the estimation list of one radiance particle that is found.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer numbers;
layout(set = 0, binding = 1) uniform usamplerBuffer found;
layout(set = 0, binding = 2) uniform usamplerBuffer starts;
layout(set = 0, binding = 3) uniform usamplerBuffer entries;
layout(set = 0, binding = 4) buffer Used { uint used[]; };
layout(set = 0, binding = 5) buffer Counts { uint counts[]; };  // word 1: area particles

layout(push_constant, scalar) uniform Push { uint all_lists; } push;

#include "particles/mesh_found.glsl"

void main() {
    uint invocation = invocation_of_found();
    if (invocation >= texelFetch(found, 3).x) {
        return;
    }
    uint list = push.all_lists != 0u ? texelFetch(numbers, int(invocation)).x : invocation;
    uint fresh = 0u;
    uint end = min(texelFetch(starts, int(list) + 1).x, uint(textureSize(entries)));
    [[dont_unroll]] for (uint entry = texelFetch(starts, int(list)).x; entry < end; ++entry) {
        fresh += 1u - atomicOr(used[texelFetch(entries, int(entry)).x], 1u);
    }
    if (fresh > 0u) {
        atomicAdd(counts[1], fresh);
    }
}
