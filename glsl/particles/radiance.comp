#version 460
#include "lib/prelude.glsl"
#include "lib/vectors.glsl"

// The radiance that one particle sends out, W/(m²·sr): L = ρ/π · φ/ΔA (Chang et al. 4.2.2), φ being all that it received.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint SCATTERED = 1u;
layout(constant_id = 1) const uint HAS_LATE = 0u;  // 1: some light comes late

layout(set = 0, binding = 0) uniform samplerBuffer matter;
layout(set = 0, binding = 1) uniform samplerBuffer total;
layout(set = 0, binding = 2) uniform samplerBuffer scale;
layout(set = 0, binding = 3) uniform usamplerBuffer received;  // in the last step
layout(set = 0, binding = 4) writeonly buffer Radiance { vec4 radiance[]; };
layout(set = 0, binding = 5) uniform samplerBuffer late;       // what lights give in as many specular events as there were steps

layout(push_constant, scalar) uniform Push {
    uint particle_count;
    uint received_first;  // where they begin, in particles
    uint late_first;
} push;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    vec3 flux = texelFetch(total, int(particle)).rgb;
    if (SCATTERED != 0u) {
        int first = 3 * int(push.received_first + particle);
        uvec3 word = uvec3(texelFetch(received, first).x, texelFetch(received, first + 1).x, texelFetch(received, first + 2).x);
        flux += vec3(word) / max(texelFetch(scale, 0).x, 1e-30);
    }
    if (HAS_LATE != 0u) {
        flux += texelFetch(late, int(push.late_first + particle)).rgb;
    }
    vec4 own = texelFetch(matter, int(particle));
    radiance[particle] = vec4(own.w > 0.0 ? own.rgb * flux * (INVERSE_PI / own.w) : vec3(0.0), 0.0);
}
