#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "lib/sobol.glsl"
#include "particles/events.glsl"
#include "particles/link.glsl"
#include "particles/places.glsl"

// One scattering step of one particle (Chang et al. 4.2.2): what it received in the step before, it reflects, and passes on along its links in equal shares.
// The first step takes all n_s² links of the particles that lights reach, each further one a single link, drawn anew for each step:
//
//   φ'_end += ρ·φ/n   for n links
//
// Where specular events are counted (events.glsl), each is a step as well: what goes along a link behind k of them is received k steps later, and what lights sent
// by way of k of them starts in step k. Sums of as many steps as that may concern lie in a ring.
//
// ρ is the albedo of the diffuse lobe; of light as lights gave it broad specular lobes pass their share of lamps' light on in the same directions, since no photon is sent to
// them and no link from elsewhere meets lamps by way of them (it does the sky). Further on, links go on off specular lobes by themselves.
//
// Sums are whole numbers of steps, so that their order does not matter. What a link takes along is rounded up with the probability of what is beyond a whole: where
// particles are small and the sun shines next door, it is less than a step.

layout(local_size_x = 64) in;

// 1: lights give some of what this step passes on; earlier steps do.
layout(constant_id = 0) const uint FROM_LIGHTS = 1u;
layout(constant_id = 1) const uint FROM_STEPS = 0u;

// 1: links have second ends, off surfaces that reflect specularly too.
layout(constant_id = 2) const uint SECOND_ENDS = 0u;

// 1: behind the diffuse albedos are those of broad specular lobes.
layout(constant_id = 3) const uint BROAD_LOBES = 0u;

// 1: what wide particles pass on is the business of scatter_wide.comp.
layout(constant_id = 7) const uint WIDE_APART = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer matter;
layout(set = 0, binding = 1) uniform samplerBuffer emitted;            // W: what lights give; the share of it that is not the sky's
layout(set = 0, binding = 2) uniform usamplerBuffer scatter_links;
layout(set = 0, binding = 3) uniform samplerBuffer scale;
layout(set = 0, binding = 4) uniform usamplerBuffer received;          // steps: what earlier steps do; red, green, blue one by one
layout(set = 0, binding = 5) buffer Next { uint next[]; };             // the same of the next step, or a ring of them
layout(set = 0, binding = 6) buffer Total { vec4 total[]; };           // W: all that was received

layout(push_constant, scalar) uniform Push {
    uint particle_count;
    uint link_count;
    uint number;      // of the step, from 0
    uint step_count;
    uint ring;        // sums in it
} push;

// Where the sum of a particle begins that a step passes on.
uint sum_of(uint step_number, uint particle) {
    return 3u * (EVENT_LEVELS > 1u ? step_number % push.ring * push.particle_count + particle : particle);
}

void add_to(uint end, uvec3 share) {
    uint later = EVENT_LEVELS > 1u ? events_of_link(end) : 0u;
    if (ends_on_particle(end) && (EVENT_LEVELS <= 1u || push.number + later < push.step_count)) {
        uint first = sum_of(push.number + 1u + later, particle_of_link(end));
        share *= channels_of_link(end);
        atomicAdd(next[first], share.r);
        atomicAdd(next[first + 1u], share.g);
        atomicAdd(next[first + 2u], share.b);
    }
}

// So many steps along each of so many links, from the number `first` on.
void pass_on(uint particle, vec3 steps, uint first, uint count) {
    if (steps == vec3(0.0)) {
        return;
    }
    uint seed = seed_of(particle, push.number);
    [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
        uint link = particle * push.link_count + first + i;
        uvec3 share = uvec3(steps + float(seed_of(seed, i) >> 8) / 16777216.0);
        add_to(texelFetch(scatter_links, int(link)).x, share);
        if (SECOND_ENDS != 0u) {
            add_to(texelFetch(scatter_links, int(push.particle_count * push.link_count + link)).x, share);
        }
    }
}

// What earlier steps brought; its place in the ring is free then.
uvec3 take_received(uint particle) {
    uint first = sum_of(push.number, particle);
    if (EVENT_LEVELS <= 1u) {
        int place = int(first);
        return uvec3(texelFetch(received, place).x, texelFetch(received, place + 1).x, texelFetch(received, place + 2).x);
    }
    uvec3 word = uvec3(next[first], next[first + 1u], next[first + 2u]);
    for (uint channel = 0u; channel < 3u; ++channel) {
        next[first + channel] = 0u;
    }
    return word;
}

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    float steps = texelFetch(scale, 0).x;
    bool apart = WIDE_APART != 0u && spacing_of_particle(particle_places, particle) >= WIDE_SPACINGS * particle_spacing;
    vec3 albedo = texelFetch(matter, int(particle)).rgb;
    vec3 sum = vec3(0.0);
    if (FROM_LIGHTS != 0u) {
        vec4 given = texelFetch(emitted, int(push.number * push.particle_count + particle));
        vec3 all = albedo;
        if (BROAD_LOBES != 0u) {
            all += given.a * texelFetch(matter, int(push.particle_count + particle)).rgb;
        }
        sum = given.rgb;
        if (!apart) {
            pass_on(particle, all * given.rgb * (steps / float(push.link_count)), 0u, push.link_count);
        }
    }
    if (FROM_STEPS != 0u) {
        vec3 flux = vec3(take_received(particle)) / max(steps, 1e-30);
        sum += flux;
        uint drawn = seed_of(seed_of(particle, 0xB0u), push.number) % push.link_count;
        if (!apart) {
            pass_on(particle, albedo * flux * steps, drawn, 1u);
        }
        total[particle] += vec4(sum, 0.0);
    } else {
        total[particle] = vec4(sum, 0.0);
    }
}
