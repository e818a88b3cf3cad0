#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "lib/sobol.glsl"
#include "particles/link.glsl"
#include "particles/places.glsl"

// One scattering step of one particle that stands for much more surface than the closest do, in place of scatter.comp: along so many of its N links for gathering,
//
//   n = min(n_s²·(s/s₀)², N) in the first step, (s/s₀)² further on        s, s₀: its spacing, that of the closest
//
// that a link carries about what one of theirs does. A sunlit ground before a window would else leave on a wall, where one of its few links ends by chance, a spot as bright
// as itself. Only where nothing is specular: links for gathering do not follow mirrors.

layout(local_size_x = 64) in;

// 1: lights give what this step passes on; the step before does.
layout(constant_id = 0) const uint FROM_LIGHTS = 1u;

layout(set = 0, binding = 0) uniform samplerBuffer matter;
layout(set = 0, binding = 1) uniform samplerBuffer emitted;    // W
layout(set = 0, binding = 2) uniform usamplerBuffer links;     // of the chunk
layout(set = 0, binding = 3) uniform samplerBuffer scale;
layout(set = 0, binding = 4) uniform usamplerBuffer received;  // steps
layout(set = 0, binding = 5) buffer Next { uint next[]; };     // the same of the next step

layout(push_constant, scalar) uniform Push {
    uint first;          // particle of the chunk
    uint count;
    uint link_count;     // N
    uint scatter_count;  // n_s²
    uint number;         // of the step, from 0
} push;

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.count) {
        return;
    }
    uint particle = push.first + own;
    float ratio = spacing_of_particle(particle_places, particle) / particle_spacing;
    if (ratio < WIDE_SPACINGS) {
        return;
    }
    vec3 steps = texelFetch(matter, int(particle)).rgb;
    if (FROM_LIGHTS != 0u) {
        steps *= texelFetch(emitted, int(particle)).rgb * texelFetch(scale, 0).x;
    } else {
        int place = 3 * int(particle);
        steps *= vec3(texelFetch(received, place).x, texelFetch(received, place + 1).x, texelFetch(received, place + 2).x);
    }
    if (steps == vec3(0.0)) {
        return;
    }
    float wanted = ratio * ratio * (FROM_LIGHTS != 0u ? float(push.scatter_count) : 1.0);
    uint taken = min(uint(wanted), push.link_count);
    steps /= float(taken);
    uint seed = seed_of(seed_of(particle, 0xB1u), push.number);
    [[dont_unroll]] for (uint i = 0u; i < taken; ++i) {
        uint link = (seed % push.link_count + i * push.link_count / taken) % push.link_count;
        uint end = texelFetch(links, int(own * push.link_count + link)).x;
        if (ends_on_particle(end)) {
            uvec3 share = uvec3(steps + float(seed_of(seed, i) >> 8) / 16777216.0);
            uint home = 3u * particle_of_link(end);
            atomicAdd(next[home], share.r);
            atomicAdd(next[home + 1u], share.g);
            atomicAdd(next[home + 2u], share.b);
        }
    }
}
