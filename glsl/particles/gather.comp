#version 460
#include "lib/prelude.glsl"
#include "lib/vectors.glsl"
#include "particles/link.glsl"

// The irradiance of indirect light at one particle that is used, W/m² (Chang et al. 4.3.1): its links are spread by the cosine, so
//
//   E = ∫ L cosθ dω ≈ π/N Σ_k L(end of link k)
//
// Interleaved, it takes a quarter of its links, its neighbours in space the others: who reads their mean (irradiance.glsl) has all (Keller & Heidrich 2001,
// with particles in place of pixels).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer used;
layout(set = 0, binding = 1) uniform usamplerBuffer links;
layout(set = 0, binding = 2) uniform samplerBuffer radiance;
layout(set = 0, binding = 3) uniform samplerBuffer matter;
layout(set = 0, binding = 4) buffer Irradiance { vec4 irradiance[]; };  // and the area of each, m²

layout(push_constant, scalar) uniform Push {
    uint first;       // particle of the chunk
    uint count;
    uint link_count;
    uint parts;       // of the links, one of which is taken: 1 or 4
} push;

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.count || texelFetch(used, int(push.first + own)).x == 0u) {
        return;
    }
    uint taken = push.link_count / push.parts;
    uint begin = own * push.link_count + (push.first + own) % push.parts * taken;
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < taken; ++i) {
        uint end = texelFetch(links, int(begin + i)).x;
        if (ends_on_particle(end)) {
            sum += texelFetch(radiance, int(particle_of_link(end))).rgb;
        }
    }
    irradiance[push.first + own] = vec4(sum * (PI / float(taken)), texelFetch(matter, int(push.first + own)).w);
}
