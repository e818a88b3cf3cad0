#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "lib/vectors.glsl"
#include "particles/lists.glsl"
#include "particles/places.glsl"

// The radiance that one particle sends out, W/(m²·sr): what lights gave it, and what was scattered to it and its neighbours,
//
//   L_i = ρ_i/π·(φ_i/ΔA_i + Σ_j k_j φ'_j/Σ_j k_j ΔA_j)        (Chang et al. 4.2.2; j: its estimation list; k = 1 − d²/r², r: KERNEL_SPACINGS)
//
// A particle gets few links of others, so that its own φ' alone is as noisy as few samples are: where many links end on it, next to an edge, it would show as a
// dot of light. What is scattered varies slowly, what lights give does not.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint SCATTERED = 1u;
layout(constant_id = 1) const uint HAS_LATE = 0u;  // 1: some light comes late

layout(set = 0, binding = 0) uniform samplerBuffer matter;
layout(set = 0, binding = 1) uniform samplerBuffer emitted;    // W
layout(set = 0, binding = 2) uniform samplerBuffer total;      // W, but for the last step
layout(set = 0, binding = 3) uniform samplerBuffer scale;
layout(set = 0, binding = 4) uniform usamplerBuffer received;  // in the last step
layout(set = 0, binding = 5) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 6) uniform usamplerBuffer lists;
layout(set = 0, binding = 7) writeonly buffer Radiance { vec4 radiance[]; };
layout(set = 0, binding = 8) uniform samplerBuffer late;       // what lights give in as many specular events as there were steps

layout(push_constant, scalar) uniform Push {
    uint particle_count;
    uint received_first;  // where they begin, in particles
    uint late_first;
} push;

vec3 scattered_flux(int particle, float watts_a_step) {
    int first = 3 * (int(push.received_first) + particle);
    uvec3 word = uvec3(texelFetch(received, first).x, texelFetch(received, first + 1).x, texelFetch(received, first + 2).x);
    return texelFetch(total, particle).rgb - texelFetch(emitted, particle).rgb + vec3(word) * watts_a_step;
}

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    vec4 own = texelFetch(matter, int(particle));
    vec3 irradiance = own.w > 0.0 ? texelFetch(emitted, int(particle)).rgb / own.w : vec3(0.0);
    if (SCATTERED != 0u) {
        float watts_a_step = 1.0 / max(texelFetch(scale, 0).x, 1e-30);
        vec4 around = vec4(0.0);
        vec3 position = uintBitsToFloat(texelFetch(particle_places, int(particle)).xyz);
        float radius = KERNEL_SPACINGS * spacing_of_particle(particle_places, particle);
        uint start = particle * LIST_CAPACITY;
        uint end = start + length_of_list(texelFetch(list_lengths, int(particle)).x);
        [[dont_unroll]] for (uint place = start; place < end; ++place) {
            int other = int(texelFetch(lists, int(place)).x);
            vec3 way = (uintBitsToFloat(texelFetch(particle_places, other).xyz) - position) / radius;
            float weight = max(1.0 - dot(way, way), 0.0);
            if (weight > 0.0) {
                around += weight * vec4(scattered_flux(other, watts_a_step), texelFetch(matter, other).w);
            }
        }
        irradiance += around.w > 0.0 ? max(around.rgb, vec3(0.0)) / around.w : vec3(0.0);
    }
    if (HAS_LATE != 0u && own.w > 0.0) {
        irradiance += texelFetch(late, int(push.late_first + particle)).rgb / own.w;
    }
    radiance[particle] = vec4(own.rgb * irradiance * INVERSE_PI, 0.0);
}
