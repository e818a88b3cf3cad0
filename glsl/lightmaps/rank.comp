#version 460
#include "lib/prelude.glsl"
#include "lightmaps/changes.glsl"
#include "lightmaps/links.glsl"

// How much the light of one texel changed since it was gathered, by what comes along its links:
//
//   L(x) = 1/N Σ_l w_l·E_AIM(y_l)        Δ(x) = max |L(x) − L_then(x)|, the greatest one of all maps, each times its light's colour
//
// Its level is Δ's exponent and two bits more, so that no unit matters; none if Δ is too small a share of L. Larsen & Christensen 2004 have such a Δ_i of each surface,
// by the energy of photons; links know it of each texel. What was gathered of other light counts as no round any more.
//
// Below all changes are the levels of texels that have fewer rounds of rays than they may have: the fewer, the higher.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer links;
layout(set = 0, binding = 1) uniform samplerBuffer received;     // the AIM
layout(set = 0, binding = 2) uniform samplerBuffer then;         // L when the texel was gathered
layout(set = 0, binding = 3) uniform usamplerBuffer used;        // texels that are read
layout(set = 0, binding = 4) writeonly buffer Now { vec4 now[]; };
layout(set = 0, binding = 5) writeonly buffer Levels { uint levels[]; };  // in the order of `used`
layout(set = 0, binding = 6) buffer Histogram { uint histogram[]; };      // how many have each level
layout(set = 0, binding = 7) buffer Gathered { vec4 gathered[]; };        // the IIM; w of the first map: rounds
layout(set = 0, binding = 8) uniform samplerBuffer tints;                 // by map

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint used_count;
    uint link_count;
    uint maps;
    uint rounds;  // that a texel may have; 0: changes alone count
} push;

// Levels below it are for rounds: a change of 2⁻¹¹¹ W/m² is none.
const uint FIRST_CHANGE = 65u;

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place >= push.used_count) {
        return;
    }
    uint number = texelFetch(used, int(place)).x;
    bool changed = false;
    float change = 0.0;
    [[dont_unroll]] for (uint map = 0u; map < push.maps; ++map) {
        uint place_in_map = map * push.texel_count + number;
        vec3 light = light_along_links(links, push.texel_count, push.link_count, number, received, map);
        vec3 before = texelFetch(then, int(place_in_map)).rgb;
        now[place_in_map] = vec4(light, 1.0);
        if (is_change(light, before)) {
            vec3 tint = texelFetch(tints, int(map)).rgb;
            changed = true;
            change = max(change, change_of(tint * light, tint * before));
        }
    }
    uint level = 0u;
    if (changed) {
        gathered[number].w = 0.0;
        level = max(floatBitsToUint(change) >> 21, FIRST_CHANGE);
    } else if (gathered[number].w < float(push.rounds)) {
        level = FIRST_CHANGE - 1u - uint(gathered[number].w);
    }
    levels[place] = level;
    if (level > 0u) {
        atomicAdd(histogram[level], 1u);
    }
}
