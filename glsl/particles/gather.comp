#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "lib/color.glsl"
#include "lib/octahedral.glsl"
#include "particles/link_direction.glsl"

// The irradiance of indirect light at one particle that is used, W/m² (Chang et al. 4.3.1): its links are spread by the cosine, so
//
//   E = ∫ L cosθ dω ≈ π/N Σ_k L(end of link k)
//
// Interleaved, it takes a quarter of its links, its neighbours in space the others: who reads their mean (irradiance.glsl) has all (Keller & Heidrich 2001,
// with particles in place of pixels).
//
// Where normal maps turn the surface against its particle, its normal being n, another one n' receives (with c = n·n', directions below the surface being dark)
//
//   E(n') ≈ E (1 + c)/2 + T·n'        T = ∫ L ω dω without its part along n ≈ π/N Σ_k L ω_k/cosθ_k
//
// which is exact for even light at any c, and for any light to the first order. T·luminance/E's is what is kept.
//
// Where receivers look for themselves at what is near (near.comp), the same of the links that end farther away, as if all did:
//
//   A ≈ π/F Σ_{k far} L(end of link k)        F: how many are far

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint TURNS = 0u;  // 1: T is wanted
layout(constant_id = 1) const uint NEAR = 0u;   // 1: A is wanted

layout(set = 0, binding = 0) uniform usamplerBuffer used;
layout(set = 0, binding = 1) uniform usamplerBuffer links;
layout(set = 0, binding = 2) uniform samplerBuffer radiance;
layout(set = 0, binding = 3) uniform samplerBuffer matter;
layout(set = 0, binding = 4) buffer Irradiance { vec4 irradiance[]; };  // and the area of each, m²; behind all of them T/E
layout(set = 0, binding = 5) buffer Far { vec4 far[]; };  // A, and the area times F over all links; behind all of them T/E of these

layout(push_constant, scalar) uniform Push {
    uint first;       // particle of the chunk
    uint count;
    uint particle_count;
    uint gather_side;
    uint parts;       // of the links, one of which is taken: 1 or 4
} push;

#include "particles/gathered.glsl"

// What links bring: radiance, with luminance along the surface, and their number.
struct Found {
    vec3 sum;
    vec2 turn;
    uint count;
};

void add_link(inout Found found, vec3 radiance, vec2 turn) {
    found.sum += radiance;
    found.turn += turn;
    found.count += 1u;
}

vec3 mean_irradiance(Found found) {
    return found.sum * (PI / float(max(found.count, 1u)));
}

vec4 tangential(Found found, Frame frame) {
    return vec4(to_world(frame, vec3(found.turn, 0.0)) / max(luminance(found.sum), 1e-30), 0.0);
}

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.count || texelFetch(used, int(push.first + own)).x == 0u) {
        return;
    }
    uint link_count = push.gather_side * push.gather_side;
    uint taken = link_count / push.parts;
    uint particle = push.first + own;
    uint begin = particle % push.parts * taken;
    Found all = Found(vec3(0.0), vec2(0.0), 0u);
    Found beyond = all;
    [[dont_unroll]] for (uint i = 0u; i < taken; ++i) {
        uint end = texelFetch(links, int(own * link_count + begin + i)).x;
        vec3 found = radiance_at_end(end);
        vec2 turn = vec2(0.0);
        if (TURNS != 0u) {
            vec2 stratum = vec2(stratum_of_link(begin + i, push.gather_side)) + 0.5;
            vec3 direction = cosine_direction(stratum / float(push.gather_side));
            turn = luminance(found) * direction.xy / direction.z;
        }
        add_link(all, found, turn);
        if (NEAR != 0u && (!ends_on_particle(end) || (end & NEAR_LINK) == 0u)) {
            add_link(beyond, found, turn);
        }
    }
    float area = texelFetch(matter, int(particle)).w;
    irradiance[particle] = vec4(mean_irradiance(all), area);
    if (NEAR != 0u) {
        far[particle] = vec4(mean_irradiance(beyond), area * (float(beyond.count) / float(taken)));
    }
    if (TURNS != 0u) {
        Frame frame = frame_around(unpack_direction(texelFetch(particle_places, int(particle)).w));
        irradiance[push.particle_count + particle] = tangential(all, frame);
        if (NEAR != 0u) {
            far[push.particle_count + particle] = tangential(beyond, frame);
        }
    }
}
