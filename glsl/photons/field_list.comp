#version 460
#include "lib/prelude.glsl"
#include "photons/field.glsl"

// Lists one photon in its bucket, in any order. Where a bucket has more than MOST_LISTED, each is listed with a chance of MOST_LISTED/number, drawn by its own place,
// and counts for as many as it stands for: loops over buckets stay short, and what they sum up the same on average.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) uniform usamplerBuffer buckets;
layout(set = 0, binding = 2) uniform usamplerBuffer starts;
layout(set = 0, binding = 3) buffer LengthBlock { uint lengths[]; };
layout(set = 0, binding = 4) writeonly buffer OrderBlock { uint order[]; };

layout(push_constant, scalar) uniform Push {
    uint count;
    float most_listed;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    uint bucket = index < push.count ? texelFetch(buckets, int(index)).x : NO_BUCKET;
    if (bucket == NO_BUCKET) {
        return;
    }
    uint start = texelFetch(starts, int(bucket)).x;
    uint number = texelFetch(starts, int(bucket) + 1).x - start;
    uvec3 place = texelFetch(photons, int(FIELD_TEXELS * index)).xyz;
    float chance = float(seed_of(seed_of(place.x, place.y), place.z) >> 8) * (1.0 / 16777216.0);
    if (chance * float(number) < push.most_listed) {
        order[start + atomicAdd(lengths[bucket], 1u)] = index;
    }
}
