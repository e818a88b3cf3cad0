#version 460
#include "lib/prelude.glsl"
#include "lightmaps/charts.glsl"
#include "lightmaps/photons.glsl"

// Counts one photon's hits by the texels where they are, or lists them there, in any order.

layout(local_size_x = 64) in;

// 1: lists them; 0: counts.
layout(constant_id = 0) const uint LISTS = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer records;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;      // of each texel's list
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };   // so far
layout(set = 0, binding = 3) buffer Hits { uvec4 hits[]; };      // two texels each; in the last word the light

layout(push_constant, scalar) uniform Push {
    uint photon_count;
    uint photons_a_light;
} push;

void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= push.photon_count) {
        return;
    }
    [[dont_unroll]] for (uint event = 1u; event < RECORDS_A_PHOTON; ++event) {
        uint record = record_of(photon, event);
        if (texelFetch(records, int(record) + 1).w != 0u) {
            break;
        }
        uint texel = texelFetch(records, int(record)).w;
        if (texel != NO_TEXEL) {
            uint place = atomicAdd(counts[texel], 1u);
            if (LISTS != 0u) {
                uint hit = 2u * (texelFetch(starts, int(texel)).x + place);
                hits[hit] = texelFetch(records, int(record));
                hits[hit + 1u] = uvec4(texelFetch(records, int(record) + 1).xyz, photon / push.photons_a_light);
            }
        }
    }
}
