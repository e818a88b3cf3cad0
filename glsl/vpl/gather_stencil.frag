#version 460
#include "lib/prelude.glsl"
#include "lib/surface_packing.glsl"
#include "lib/vpl.glsl"
#include "regions/planes.glsl"
#include "regions/regions.glsl"

// Irradiance E [W/m²] of one region whose stencil is marked: the sum over all VPLs at the region's receiver (vpl/gather.glsl). The alpha of
// what it writes is the receiver's normal, packed, which is above 0. It counts itself.

layout(early_fragment_tests) in;

layout(set = 0, binding = 2) uniform samplerBuffer vpls;
layout(set = 0, binding = 3) buffer Invocations { uint invocations[]; };

layout(location = 0) out vec4 irradiance;

#include "vpl/gather.glsl"
#include "vpl/receivers.glsl"

layout(push_constant, scalar) uniform Push {
    ivec2 size;         // pixels
    int level_count;
    VplRange range;
} push;

void main() {
    bool first = push.range.first == 0;
    if (first) {
        atomicAdd(invocations[0], 1u);
    }
    Receiver receiver = receiver_of_region(region_at(push.size, ivec2(gl_FragCoord.xy), push.level_count), push.size);
    vec3 sum;
    gather(push.range, receiver, sum);
    irradiance = vec4(sum, first ? pack_direction_in_float(receiver.normal) : 0.0);
}
