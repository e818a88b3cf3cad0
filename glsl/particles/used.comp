#version 460
#include "lib/prelude.glsl"
#include "particles/lists.glsl"

// Marks the particles in the list of one that pixels are at.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer marks;
layout(set = 0, binding = 1) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 2) uniform usamplerBuffer lists;
layout(set = 0, binding = 3) buffer Used { uint used[]; };
layout(set = 0, binding = 4) buffer Counts { uint counts[]; };  // homes, particles in their lists

layout(push_constant, scalar) uniform Push { uint particle_count; } push;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count || texelFetch(marks, int(particle)).x == 0u) {
        return;
    }
    uint fresh = 0u;
    uint first = particle * LIST_CAPACITY;
    uint end = first + length_of_list(texelFetch(list_lengths, int(particle)).x);
    [[dont_unroll]] for (uint place = first; place < end; ++place) {
        fresh += 1u - atomicOr(used[texelFetch(lists, int(place)).x], 1u);
    }
    atomicAdd(counts[0], 1u);
    atomicAdd(counts[1], fresh);
}
