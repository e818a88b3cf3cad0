#version 460
#include "lib/prelude.glsl"

// Lists one particle in its bucket and takes it off the bucket's count, which ends at zero. The order within a bucket is any.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer buckets;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };
layout(set = 0, binding = 3) writeonly buffer Order { uint order[]; };

layout(push_constant, scalar) uniform Push { uint particle_count; } push;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    uint bucket = texelFetch(buckets, int(particle)).x;
    uint place = atomicAdd(counts[bucket], 0xFFFFFFFFu) - 1u;
    order[texelFetch(starts, int(bucket)).x + place] = particle;
}
