#version 460
#include "lib/prelude.glsl"
#include "points/fixed_point.glsl"
#include "photons/kept.glsl"

// The flux of all photons together in their brightest channels, in wholes by which all photons of the largest flux would have 2³¹: what fixed point is scaled by
// (points/fixed_point.glsl). Few photons are as bright as the brightest one, and many places hold none.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) buffer FluxBlock { uint fluxes[]; };  // peak.comp; the total

layout(push_constant, scalar) uniform Push {
    uint count;
    uint count_log2;
} push;

shared uint sum;

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        sum = 0u;
    }
    barrier();
    uint index = gl_GlobalInvocationID.x;
    if (index < push.count) {
        float scale = power_of_two(exponent_by_peak(fluxes[0], push.count_log2));
        atomicAdd(sum, uint(ceil(max3(flux_of_kept(photons, index)) * scale)));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && sum > 0u) {
        atomicAdd(fluxes[1], sum);
    }
}
