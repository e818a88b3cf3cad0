#version 460
#include "lib/prelude.glsl"
#include "lib/sobol.glsl"
#include "particles/link.glsl"

// One scattering step of one particle (Chang et al. 4.2.2): what it received in the step before, it reflects, and passes on along its links in equal shares.
// The first step takes all n_s² links of the particles that lights reach, each further one a single link, drawn anew for each step:
//
//   φ'_end += ρ·φ/n   for n links
//
// ρ is the albedo of the diffuse lobe; in the first step broad specular lobes pass their share of lamps' light on in the same directions, since no photon is sent to
// them and no link from elsewhere meets lamps by way of them (it does the sky). Further on, links go on off specular lobes by themselves.
//
// Sums are whole numbers of steps, rounded to nearest, so that their order does not matter.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint FIRST = 1u;

// 1: links have second ends, off surfaces that reflect specularly too.
layout(constant_id = 2) const uint SECOND_ENDS = 0u;

// 1: behind the diffuse albedos are those of broad specular lobes.
layout(constant_id = 3) const uint BROAD_LOBES = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer matter;
layout(set = 0, binding = 1) uniform samplerBuffer emitted;            // W: what the first step passes on; the share of it that is not the sky's
layout(set = 0, binding = 2) uniform usamplerBuffer scatter_links;
layout(set = 0, binding = 3) uniform samplerBuffer scale;
layout(set = 0, binding = 4) uniform usamplerBuffer received;          // steps: what the others do; red, green, blue one by one
layout(set = 0, binding = 5) buffer Next { uint next[]; };
layout(set = 0, binding = 6) buffer Total { vec4 total[]; };           // W: all that was received

layout(push_constant, scalar) uniform Push {
    uint particle_count;
    uint link_count;
    uint number;  // of the step, from 0
} push;

void add_to(uint end, uvec3 share) {
    if (ends_on_particle(end)) {
        uint first = 3u * particle_of_link(end);
        share *= channels_of_link(end);
        atomicAdd(next[first], share.r);
        atomicAdd(next[first + 1u], share.g);
        atomicAdd(next[first + 2u], share.b);
    }
}

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    float steps = texelFetch(scale, 0).x;
    vec3 flux;
    vec3 albedo = texelFetch(matter, int(particle)).rgb;
    if (FIRST != 0u) {
        vec4 given = texelFetch(emitted, int(particle));
        flux = given.rgb;
        if (BROAD_LOBES != 0u) {
            albedo += given.a * texelFetch(matter, int(push.particle_count + particle)).rgb;
        }
        total[particle] = vec4(flux, 0.0);
    } else {
        int first = 3 * int(particle);
        uvec3 word = uvec3(texelFetch(received, first).x, texelFetch(received, first + 1).x, texelFetch(received, first + 2).x);
        flux = vec3(word) / max(steps, 1e-30);
        total[particle] += vec4(flux, 0.0);
    }
    uint count = FIRST != 0u ? push.link_count : 1u;
    uvec3 share = uvec3(albedo * flux * (steps / float(count)) + 0.5);
    if (share == uvec3(0u)) {
        return;
    }
    uint drawn = FIRST != 0u ? 0u : seed_of(seed_of(particle, 0xB0u), push.number) % push.link_count;
    [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
        uint link = particle * push.link_count + drawn + i;
        add_to(texelFetch(scatter_links, int(link)).x, share);
        if (SECOND_ENDS != 0u) {
            add_to(texelFetch(scatter_links, int(push.particle_count * push.link_count + link)).x, share);
        }
    }
}
