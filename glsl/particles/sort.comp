#version 460
#include "lib/prelude.glsl"

// Puts one particle to its place among the entries of its bucket, in the order of their numbers: the same every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer order;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) uniform usamplerBuffer places;
layout(set = 0, binding = 3) uniform usamplerBuffer buckets;
layout(set = 0, binding = 4) writeonly buffer Numbers { uint numbers[]; };
layout(set = 0, binding = 5) writeonly buffer Sorted { uvec4 sorted[]; };

layout(push_constant, scalar) uniform Push { uint particle_count; } push;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    int bucket = int(texelFetch(buckets, int(particle)).x);
    uint first = texelFetch(starts, bucket).x;
    uint end = texelFetch(starts, bucket + 1).x;
    uint place = first;
    [[dont_unroll]] for (uint other = first; other < end; ++other) {
        place += texelFetch(order, int(other)).x < particle ? 1u : 0u;
    }
    numbers[place] = particle;
    sorted[place] = texelFetch(places, int(particle));
}
