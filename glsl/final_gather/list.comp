#version 460
#include "lib/prelude.glsl"
#include "lib/sobol.glsl"
#include "final_gather/records.glsl"

// Puts one record to its bucket, in any order. Where a bucket has more than `most`, each goes in with a chance of most/number and carries what those left out
// would have: loops over buckets stay short, and what they sum up the same on average.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer records;
layout(set = 0, binding = 1) uniform usamplerBuffer buckets;
layout(set = 0, binding = 2) uniform usamplerBuffer starts;
layout(set = 0, binding = 3) uniform usamplerBuffer head;         // word `word`: how many records there are
layout(set = 0, binding = 4) buffer Lengths { uint lengths[]; };  // of the buckets' lists
layout(set = 0, binding = 5) writeonly buffer Listed { MapRecord listed[]; };

layout(push_constant, scalar) uniform Push {
    uint capacity;  // of the records
    uint word;
    uint most;
} push;

void main() {
    uint record = gl_GlobalInvocationID.x;
    if (record >= min(texelFetch(head, int(push.word)).x, push.capacity)) {
        return;
    }
    uint bucket = texelFetch(buckets, int(record)).x;
    uint start = texelFetch(starts, int(bucket)).x;
    float share = min(float(push.most) / float(texelFetch(starts, int(bucket) + 1).x - start), 1.0);
    uvec4 light = texelFetch(records, 2 * int(record) + 1);
    if (chance_of(light.w, 1u) >= share) {
        return;
    }
    light.xyz = share < 1.0 ? floatBitsToUint(uintBitsToFloat(light.xyz) / share) : light.xyz;
    uint place = start + atomicAdd(lengths[bucket], 1u);
    listed[place] = MapRecord(texelFetch(records, 2 * int(record)), light);
}
