#version 460
#include "lib/prelude.glsl"
#include "photons/kept.glsl"

// The largest flux of any photon in its brightest channel, W, as the bits of a float: what fixed point is scaled by (points/fixed_point.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) buffer FluxBlock { uint fluxes[]; };  // the peak · total.comp

layout(push_constant, scalar) uniform Push { uint count; } push;

shared uint largest;

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        largest = 0u;
    }
    barrier();
    uint index = gl_GlobalInvocationID.x;
    if (index < push.count) {
        // Bits of positive floats have the order of the floats.
        atomicMax(largest, floatBitsToUint(max3(flux_of_kept(photons, index))));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && largest > 0u) {
        atomicMax(fluxes[0], largest);
    }
}
