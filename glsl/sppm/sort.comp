#version 460
#include "lib/prelude.glsl"
#include "sppm/photon.glsl"

// Lists one photon in its bucket, and takes it off the bucket's count, which ends at zero. The order within a bucket is any.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photon_queue;
layout(set = 0, binding = 1) uniform usamplerBuffer photons;
layout(set = 0, binding = 2) uniform usamplerBuffer bucket_starts;
layout(set = 0, binding = 3) buffer CountBlock { uint bucket_counts[]; };
layout(set = 0, binding = 4) writeonly buffer OrderBlock { uint photon_order[]; };

void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= texelFetch(photon_queue, 3).x) {
        return;
    }
    uint bucket = texelFetch(photons, PHOTON_TEXELS * int(photon)).w;
    uint place = atomicAdd(bucket_counts[bucket], 0xFFFFFFFFu) - 1u;
    photon_order[texelFetch(bucket_starts, int(bucket)).x + place] = photon;
}
