#version 460
#include "lib/prelude.glsl"
#include "lib/append.glsl"
#include "lib/sobol.glsl"
#include "final_gather/records.glsl"

// Whether one photon is a point at which irradiance is estimated: of those of a cell that lie on the same side of a surface so many that a disc of radius r has
// some wherever there is light.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;  // as listed
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) uniform usamplerBuffer lengths;
layout(set = 0, binding = 3) uniform usamplerBuffer head;     // how many photons there are
layout(set = 0, binding = 4) writeonly buffer Chosen { uint chosen[]; };
layout(set = 0, binding = 5) buffer Arguments { uint arguments[]; };  // groups of those who work on the chosen ones, in three words, and their number

layout(push_constant, scalar) uniform Push {
    uint capacity;        // of photons
    uint room;            // for the chosen ones
    uint bits;
    float inverse_cell;   // 1/m
    float wanted;         // points in as much surface as a cell of the photons' grid has
} push;

bool is_chosen(uint place) {
    if (place >= min(texelFetch(head, 0).x, push.capacity)) {
        return false;
    }
    // Between the lists of full buckets there is room that nothing was put to: a bucket's list tells who is in it.
    uvec4 own = texelFetch(photons, 2 * int(place));
    ivec3 cell = cell_of(uintBitsToFloat(own.xyz), push.inverse_cell);
    int bucket = int(bucket_of(cell, push.bits));
    int first = int(texelFetch(starts, bucket).x);
    int end = first + int(texelFetch(lengths, bucket).x);
    if (int(place) < first || int(place) >= end) {
        return false;
    }
    vec3 normal = unpack_direction(own.w);
    uint population = 0u;
    [[dont_unroll]] for (int other = first; other < end; ++other) {
        uvec4 where = texelFetch(photons, 2 * other);
        bool here = cell_of(uintBitsToFloat(where.xyz), push.inverse_cell) == cell;
        population += here && dot(unpack_direction(where.w), normal) > 0.5 ? 1u : 0u;
    }
    uint number = texelFetch(photons, 2 * int(place) + 1).w;
    return chance_of(number, 2u) * float(population) < push.wanted;
}

void main() {
    uint place = gl_GlobalInvocationID.x;
    bool wanted = is_chosen(place);
    uint own;
    APPEND(arguments[3], wanted, own, { atomicMax(arguments[0], (min(new_length, push.room) + 63u) / 64u); })
    if (gl_GlobalInvocationID.x == 0u) {
        arguments[1] = 1u;
        arguments[2] = 1u;
    }
    if (wanted && own < push.room) {
        chosen[own] = place;
    }
}
