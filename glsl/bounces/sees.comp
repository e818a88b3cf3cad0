#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "bounces/samples.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"

// Whether one sample of the surfaces sees clusters of others, 32 in a word: a ray to one sample of each, another one for each that looks, so that of a cluster that is hidden
// in part as many see it as see its parts.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer samples;
layout(set = 0, binding = 1) writeonly buffer SeesBlock { uint sees[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint cluster;      // samples
    uint words;        // of a sample
} push;

// The member of a cluster that a ray is sent to, among those that face the sample; `slot_count` if none does.
uint target_of(SurfaceSample point, uint first, uint turn) {
    [[dont_unroll]] for (uint step = 0u; step < push.cluster; ++step) {
        uint member = first + (turn + step) % push.cluster;
        if (face_each_other(point, load_sample(samples, member))) {
            return member;
        }
    }
    return push.slot_count;
}

void main() {
    uint self = gl_GlobalInvocationID.x / push.words;
    uint word = gl_GlobalInvocationID.x % push.words;
    if (self >= push.slot_count) {
        return;
    }
    SurfaceSample point = load_sample(samples, self);
    uint bits = 0u;
    [[dont_unroll]] for (uint bit = 0u; bit < 32u && point.area > 0.0; ++bit) {
        uint first = (32u * word + bit) * push.cluster;
        uint target = first < push.slot_count ? target_of(point, first, mix_bits(self * 0x9E3779B9u + first)) : push.slot_count;
        if (target < push.slot_count) {
            SurfaceSample other = load_sample(samples, target);
            vec3 origin = offset_ray_origin(point.position, point.normal);
            vec3 way = offset_ray_origin(other.position, other.normal) - origin;
            bits |= is_occluded(origin, way, 1.0) ? 0u : 1u << bit;
        }
    }
    sees[self * push.words + word] = bits;
}
