#version 460
#include "lib/prelude.glsl"
#include "lib/finite.glsl"
#include "path/pixels.glsl"

// Adds a wave's samples of one pixel to the sums of its slots, in the order of the samples, and clears what was added. What is no number is
// left out and counted.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer RadianceBlock { vec4 path_radiance[]; };
layout(set = 0, binding = 1) buffer SumBlock { vec4 slot_sums[]; };
layout(set = 0, binding = 2) buffer DroppedBlock { uint dropped_samples[]; };

layout(push_constant, scalar) uniform Push {
    uint paths_per_sample;
    uint sample_count;
    uint path_count;
    uint slot_count;
} push;

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place >= push.paths_per_sample) {
        return;
    }
    for (uint slot = 0u; slot < push.slot_count; ++slot) {
        vec4 sum = slot_sums[slot * push.paths_per_sample + place];
        for (uint number = 0u; number < push.sample_count; ++number) {
            uint from = slot * push.path_count + number * push.paths_per_sample + place;
            vec4 radiance = path_radiance[from];
            if (is_finite(radiance)) {
                sum += radiance;
            } else {
                atomicAdd(dropped_samples[0], 1u);
            }
            path_radiance[from] = vec4(0.0);
        }
        slot_sums[slot * push.paths_per_sample + place] = sum;
    }
}
