#version 460
#include "lib/prelude.glsl"
#include "lightmaps/changes.glsl"
#include "lightmaps/links.glsl"

// How much the light of one texel changed since it was gathered, by what comes along its links:
//
//   L(x) = 1/N Σ_l w_l·E_AIM(y_l)        Δ(x) = max |L(x) − L_then(x)|
//
// Its level is Δ's exponent and two bits more, so that no unit matters; 0 if Δ is too small a share of L. Larsen & Christensen 2004 have such a Δ_i of each surface,
// by the energy of photons; links know it of each texel.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer links;
layout(set = 0, binding = 1) uniform samplerBuffer received;     // the AIM
layout(set = 0, binding = 2) uniform samplerBuffer then;         // L when the texel was gathered
layout(set = 0, binding = 3) uniform usamplerBuffer used;        // texels that are read
layout(set = 0, binding = 4) writeonly buffer Now { vec4 now[]; };
layout(set = 0, binding = 5) writeonly buffer Levels { uint levels[]; };  // in the order of `used`
layout(set = 0, binding = 6) buffer Histogram { uint histogram[]; };      // how many have each level

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint used_count;
    uint link_count;
} push;

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place >= push.used_count) {
        return;
    }
    uint number = texelFetch(used, int(place)).x;
    vec3 light = light_along_links(links, push.texel_count, push.link_count, number, received);
    vec3 before = texelFetch(then, int(number)).rgb;
    uint level = is_change(light, before) ? max(floatBitsToUint(change_of(light, before)) >> 21, 1u) : 0u;
    now[number] = vec4(light, 1.0);
    levels[place] = level;
    if (level > 0u) {
        atomicAdd(histogram[level], 1u);
    }
}
