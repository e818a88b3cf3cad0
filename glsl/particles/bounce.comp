#version 460
#include "lib/prelude.glsl"

// One bounce of one particle by gathering, in place of scattering (Schmitz et al. 2008, as Chang et al. 5.1 compare with it): what lights gave it and what all
// its links bring of the radiance of the bounce before,
//
//   L'_i = ρ_i/π·(φ_i/ΔA_i + π/N·Σ_k L(end of link k) + π/n_s²·Σ_m L(end of link m))        W/(m²·sr)
//
// so that after b bounces L holds light that was scattered up to b + 1 times, as after b steps of scattering. k: its links for gathering, which end at the first
// surface. m: those of its links for scattering that lead on behind it, off mirrors and coats and through glass; light takes them both ways.
//
// Where specular events are counted (events.glsl), links behind k of them bring the radiance of k bounces earlier, and bounce number b has what lights sent by way of
// less than b of them. So many earlier bounces lie in a ring, with what broad specular lobes send on; the last one, without, is what pictures are made of.

layout(local_size_x = 64) in;

// 1: links for scattering have second ends, and some lead behind specular surfaces.
layout(constant_id = 0) const uint SECOND_ENDS = 0u;

// 1: behind the diffuse albedos are those of broad specular lobes.
layout(constant_id = 1) const uint BROAD_LOBES = 0u;

// 1: where events are counted, the last one.
layout(constant_id = 2) const uint LAST = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer links;
layout(set = 0, binding = 1) uniform usamplerBuffer scatter_links;
layout(set = 0, binding = 2) uniform samplerBuffer radiance;   // of the bounce before
layout(set = 0, binding = 3) uniform samplerBuffer matter;
layout(set = 0, binding = 4) uniform samplerBuffer emitted;    // W
layout(set = 0, binding = 5) buffer Next { vec4 next[]; };
layout(set = 0, binding = 6) buffer Earlier { vec4 earlier[]; };  // the ring

layout(push_constant, scalar) uniform Push {
    uint first;          // particle of the chunk
    uint count;
    uint link_count;
    uint scatter_count;  // links for scattering of each particle
    uint second_ends;    // where they begin
    uint number;         // of the bounce, from 1
    uint ring;           // bounces in it
    uint particle_count;
} push;

#include "particles/events.glsl"
#include "particles/gathered.glsl"

vec3 broad_albedo(int other) {
    return texelFetch(matter, textureSize(matter) / 2 + other).rgb;
}

// What broad specular lobes send on of lamps' light (scatter.comp), which is not in the radiance that pictures are made of.
vec3 broad_radiance(uint end) {
    if (BROAD_LOBES == 0u || !ends_on_particle(end)) {
        return vec3(0.0);
    }
    int other = int(particle_of_link(end));
    vec4 given = texelFetch(emitted, other);
    float area = texelFetch(matter, other).w;
    return broad_albedo(other) * given.rgb * (given.a * INVERSE_PI / max(area, 1e-30));
}

vec3 radiance_behind(uint link) {
    uint end = texelFetch(scatter_links, int(link)).x;
    return ends_on_particle(end) && events_of_link(end) > 0u ? vec3(channels_of_link(end)) * (texelFetch(radiance, int(particle_of_link(end))).rgb + broad_radiance(end)) : vec3(0.0);
}

uint place_in_ring(uint number, uint particle) {
    return number % push.ring * push.particle_count + particle;
}

// What an end sent on, so many bounces ago and more by the events of the link.
vec3 earlier_radiance(uint end) {
    uint ago = 1u + events_of_link(end);
    if (!ends_on_particle(end) || push.number <= ago) {
        return vec3(0.0);
    }
    return vec3(channels_of_link(end)) * earlier[place_in_ring(push.number - ago, particle_of_link(end))].rgb;
}

vec3 earlier_behind(uint link) {
    uint end = texelFetch(scatter_links, int(link)).x;
    return ends_on_particle(end) && events_of_link(end) > 0u ? earlier_radiance(end) : vec3(0.0);
}

void bounce_counted(uint own, uint particle) {
    vec4 self = texelFetch(matter, int(particle));
    vec3 given = vec3(0.0);
    vec3 given_by_lamps = vec3(0.0);
    [[dont_unroll]] for (uint level = 0u; level < min(EVENT_LEVELS, push.number); ++level) {
        vec4 more = texelFetch(emitted, int(level * push.particle_count + particle));
        given += more.rgb;
        given_by_lamps += more.rgb * more.a;
    }
    vec3 gathered = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < push.link_count; ++i) {
        uint end = texelFetch(links, int(own * push.link_count + i)).x;
        gathered += earlier_radiance(end);
    }
    vec3 behind = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < push.scatter_count; ++i) {
        uint link = particle * push.scatter_count + i;
        behind += earlier_behind(link) + earlier_behind(push.second_ends + link);
    }
    vec3 irradiance = given / max(self.w, 1e-30) + gathered * (PI / float(push.link_count)) + behind * (PI / float(push.scatter_count));
    vec3 sent = self.rgb * irradiance;
    if (LAST != 0u) {
        next[particle] = vec4(self.w > 0.0 ? sent * INVERSE_PI : vec3(0.0), 0.0);
        return;
    }
    if (BROAD_LOBES != 0u) {
        sent += broad_albedo(int(particle)) * given_by_lamps / max(self.w, 1e-30);
    }
    earlier[place_in_ring(push.number, particle)] = vec4(self.w > 0.0 ? sent * INVERSE_PI : vec3(0.0), 0.0);
}

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.count) {
        return;
    }
    uint particle = push.first + own;
    if (EVENT_LEVELS > 1u) {
        bounce_counted(own, particle);
        return;
    }
    vec4 self = texelFetch(matter, int(particle));
    vec3 gathered = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < push.link_count; ++i) {
        uint link = own * push.link_count + i;
        gathered += radiance_at_end(texelFetch(links, int(link)).x);
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
