#version 460
#include "lib/prelude.glsl"
#include "particles/tallies.glsl"

// Area and mean albedo of one particle, out of what was counted (catch.comp), and behind those of all the albedo of broad specular lobes.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer tallies;
layout(set = 0, binding = 1) uniform FacetSize { float facet_size; };
layout(set = 0, binding = 2) writeonly buffer Matter { vec4 matter[]; };  // albedo, area in m²

layout(push_constant, scalar) uniform Push {
    uint particle_count;
} push;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    uvec4 tally = texelFetch(tallies, int(tally_texels() * particle));
    float area = float(tally.x) * area_step(facet_size);
    float steps = ALBEDO_STEPS * max(float(tally.x), 1.0);
    matter[particle] = vec4(vec3(tally.yzw) / steps, area);
    if (BROAD_LOBES != 0u) {
        uvec4 broad = texelFetch(tallies, int(tally_texels() * particle + 1u));
        matter[push.particle_count + particle] = vec4(vec3(broad.xyz) / steps, 0.0);
    }
}
