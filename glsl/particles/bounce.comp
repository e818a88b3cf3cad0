#version 460
#include "lib/prelude.glsl"

// One bounce of one particle by gathering, in place of scattering (Schmitz et al. 2008, as Chang et al. 5.1 compare with it): what lights gave it and what all
// its links bring of the radiance of the bounce before,
//
//   L'_i = ρ_i/π·(φ_i/ΔA_i + π/N·Σ_k L(end of link k) + π/n_s²·Σ_m L(end of link m))        W/(m²·sr)
//
// so that after b bounces L holds light that was scattered up to b + 1 times, as after b steps of scattering. k: its links for gathering, which end at the first
// surface. m: those of its links for scattering that lead on behind it, off mirrors and coats and through glass; light takes them both ways.

layout(local_size_x = 64) in;

// 1: links for scattering have second ends, and some lead behind specular surfaces.
layout(constant_id = 0) const uint SECOND_ENDS = 0u;

// 1: behind the diffuse albedos are those of broad specular lobes.
layout(constant_id = 1) const uint BROAD_LOBES = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer links;
layout(set = 0, binding = 1) uniform usamplerBuffer scatter_links;
layout(set = 0, binding = 2) uniform samplerBuffer radiance;   // of the bounce before
layout(set = 0, binding = 3) uniform samplerBuffer matter;
layout(set = 0, binding = 4) uniform samplerBuffer emitted;    // W
layout(set = 0, binding = 5) buffer Next { vec4 next[]; };

layout(push_constant, scalar) uniform Push {
    uint first;          // particle of the chunk
    uint count;
    uint link_count;
    uint scatter_count;  // links for scattering of each particle
    uint second_ends;    // where they begin
} push;

#include "particles/gathered.glsl"

// What broad specular lobes send on of lamps' light (scatter.comp), which is not in the radiance that pictures are made of.
vec3 broad_radiance(uint end) {
    if (BROAD_LOBES == 0u || !ends_on_particle(end)) {
        return vec3(0.0);
    }
    int other = int(particle_of_link(end));
    vec4 given = texelFetch(emitted, other);
    float area = texelFetch(matter, other).w;
    vec3 albedo = texelFetch(matter, textureSize(matter) / 2 + other).rgb;
    return albedo * given.rgb * (given.a * INVERSE_PI / max(area, 1e-30));
}

vec3 radiance_behind(uint link) {
    uint end = texelFetch(scatter_links, int(link)).x;
    return ends_on_particle(end) && is_behind(end) ? vec3(channels_of_link(end)) * (texelFetch(radiance, int(particle_of_link(end))).rgb + broad_radiance(end)) : vec3(0.0);
}

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.count) {
        return;
    }
    uint particle = push.first + own;
    vec4 self = texelFetch(matter, int(particle));
    vec3 gathered = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < push.link_count; ++i) {
        uint link = own * push.link_count + i;
        gathered += radiance_at_end(link);
        if (BROAD_LOBES != 0u) {
            gathered += broad_radiance(texelFetch(links, int(link)).x);
        }
    }
    vec3 irradiance = texelFetch(emitted, int(particle)).rgb / max(self.w, 1e-30) + gathered * (PI / float(push.link_count));
    if (SECOND_ENDS != 0u) {
        vec3 sum = vec3(0.0);
        [[dont_unroll]] for (uint i = 0u; i < push.scatter_count; ++i) {
            uint link = particle * push.scatter_count + i;
            sum += radiance_behind(link) + radiance_behind(push.second_ends + link);
        }
        irradiance += sum * (PI / float(push.scatter_count));
    }
    next[particle] = vec4(self.w > 0.0 ? self.rgb * irradiance * INVERSE_PI : vec3(0.0), 0.0);
}
