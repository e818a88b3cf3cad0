#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

// Writes the estimation list of one radiance particle: the numbers of its area particles, from starts[i] to starts[i + 1].

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer tessellation;
layout(set = 0, binding = 1) uniform usamplerBuffer numbers;
layout(set = 0, binding = 2) uniform usamplerBuffer found;
layout(set = 0, binding = 3) uniform usamplerBuffer slots;
layout(set = 0, binding = 4) uniform usamplerBuffer starts;
layout(set = 0, binding = 5) writeonly buffer Entries { uint entries[]; };

layout(push_constant, scalar) uniform Push {
    uint all_count;   // 0: those found alone
    uint capacity;    // of the entries
} push;

#include "particles/home.glsl"
#include "particles/mesh_found.glsl"
#include "particles/mesh_particle.glsl"
#include "particles/mesh_slot.glsl"

uvec2 held;
uint next_entry;

void take_candidate(uint number, uint entry, uvec4 record, vec3 way) {
    if ((held[number >> 5] >> (number & 31u) & 1u) != 0u) {
        if (next_entry < push.capacity) {
            entries[next_entry] = particle_of_entry(entry);
        }
        ++next_entry;
    }
}

#include "particles/mesh_candidates.glsl"

void main() {
    uint slot = invocation_of_found();
    uint count = push.all_count > 0u ? push.all_count : texelFetch(found, 3).x;
    if (slot >= count) {
        return;
    }
    uvec4 record = texelFetch(slots, int(slot));
    if (length_of_slot(record) == 0u) {
        return;
    }
    uint number = push.all_count > 0u ? slot : texelFetch(numbers, int(slot)).x;
    RadianceParticle particle = radiance_particle(number, particle_spacing);
    held = record.xy;
    next_entry = texelFetch(starts, int(slot)).x;
    each_candidate(particle.position, particle.normal, record.z >> 8);
}
