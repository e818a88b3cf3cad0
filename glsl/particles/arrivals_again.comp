#version 460
#include "lib/prelude.glsl"
#include "particles/again.glsl"
#include "particles/arrivals.glsl"
#include "particles/events.glsl"
#include "particles/moved.glsl"

// What the links of one particle bring without those that are traced again: the sky by those that go on escaping, and nothing else, if any is; else as it was.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer head;
layout(set = 0, binding = 1) uniform usamplerBuffer states;
layout(set = 0, binding = 2) buffer Arrivals { uint arrivals[]; };

layout(push_constant, scalar) uniform Push {
    uint first;  // particle of the chunk
    uint count;
    uint particle_count;
} push;

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.count) {
        return;
    }
    bool all = texelFetch(head, int(ALL_AGAIN)).x != 0u;
    uint state = texelFetch(states, int(own)).x;
    if (!all && state < TRACED_AGAIN) {
        return;
    }
    uint sky = all ? 0u : (state - TRACED_AGAIN) * SKY_STEPS;
    uint first = (push.first + own) * arrival_words();
    for (uint word = 0u; word < arrival_words(); ++word) {
        arrivals[first + word] = word < EMISSION_WORD ? sky : 0u;
    }
    [[dont_unroll]] for (uint events = 1u; events < EVENT_LEVELS; ++events) {
        uint late = late_sky(push.particle_count, push.first + own, events);
        for (uint channel = 0u; channel < 3u; ++channel) {
            arrivals[late + channel] = 0u;
        }
    }
}
