#version 460
#include "lib/prelude.glsl"
#include "lightmaps/photons.glsl"

// Exact invalidation: the group of one photon has to be sent again if a stretch of its path crosses a box that something moved out of or into (Dmitriev et al. 2002
// ask bounding volumes of whole groups).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer records;
layout(set = 0, binding = 1) uniform samplerBuffer boxes;           // lowest and highest corner each
layout(set = 0, binding = 2) buffer Stale { uint stale[]; };

layout(push_constant, scalar) uniform Push {
    uint photon_count;
    uint box_count;
} push;

// `end`: of the way from the one point to the other.
bool crosses(vec3 from, vec3 to, float end, vec3 low, vec3 high) {
    vec3 way = to - from;
    vec3 inverse = 1.0 / mix(way, vec3(1e-30), lessThan(abs(way), vec3(1e-30)));
    vec3 a = (low - from) * inverse;
    vec3 b = (high - from) * inverse;
    vec3 enter = min(a, b);
    vec3 leave = max(a, b);
    return max(max(enter.x, enter.y), max(enter.z, 0.0)) <= min(min(leave.x, leave.y), min(leave.z, end));
}

void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= push.photon_count) {
        return;
    }
    vec3 from = uintBitsToFloat(texelFetch(records, int(record_of(photon, 0u))).xyz);
    bool met = false;
    [[dont_unroll]] for (uint event = 1u; event < RECORDS_A_PHOTON && !met; ++event) {
        int record = int(record_of(photon, event));
        uint ends = texelFetch(records, record + 1).w;
        if (ends == PATH_ENDED) {
            break;
        }
        vec3 to = uintBitsToFloat(texelFetch(records, record).xyz);
        [[dont_unroll]] for (uint box = 0u; box < push.box_count; ++box) {
            vec3 low = texelFetch(boxes, 2 * int(box)).xyz;
            vec3 high = texelFetch(boxes, 2 * int(box) + 1).xyz;
            met = met || crosses(from, to, ends == PATH_LEFT ? 3e38 : 1.0, low, high);
        }
        if (ends == PATH_LEFT) {
            break;
        }
        from = to;
    }
    if (met) {
        atomicMax(stale[photon / PHOTONS_A_GROUP], 1u);
    }
}
