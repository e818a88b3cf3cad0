#version 460
#include "lib/prelude.glsl"
#include "bounces/samples.glsl"
#include "lib/finite.glsl"
#include "lib/vpl.glsl"

// One invocation makes a sample of the surfaces a virtual area light of what it reflects of all bounces' light, Φ = ρ A ΣE in W, or an empty slot.

layout(local_size_x = 64) in;

// 1: caches add the area of a light to its squared distance, the paper, and not that over π.
layout(constant_id = 0) const uint PAPER = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer samples;
layout(set = 0, binding = 1) uniform samplerBuffer matter;  // bounces/albedo.comp
layout(set = 0, binding = 2) uniform samplerBuffer sums;    // ΣE, W/m²
layout(set = 0, binding = 3) writeonly buffer SlotBlock { vec4 slots[]; };

layout(push_constant, scalar) uniform Push {
    vec3 shift;  // from render space to the rays' space
    uint slot_count;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.slot_count) {
        return;
    }
    SurfaceSample point = load_sample(samples, index);
    vec4 made = texelFetch(matter, int(index));
    vec3 flux = made.w * made.rgb * texelFetch(sums, int(index)).rgb;
    bool lit = max3(flux) > 0.0 && is_finite(flux);
    slots[2u * index] = lit ? pack_vpl_position(point.position - push.shift, PAPER != 0u ? PI * point.area : point.area) : vec4(0.0);
    slots[2u * index + 1u] = lit ? pack_vpl_strength(flux, point.normal) : vec4(0.0);
}
