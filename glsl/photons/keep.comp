#version 460
#include "lib/prelude.glsl"
#include "lib/finite.glsl"
#include "photons/records.glsl"

// Keeps one photon of a turn where it landed, or empties its place (photons/kept.glsl). What is no number is left out and counted.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer landed;    // photons/records.glsl
layout(set = 0, binding = 1) uniform samplerBuffer ellipses;
layout(set = 0, binding = 2) uniform usamplerBuffer counts;
layout(set = 0, binding = 3) writeonly buffer PhotonBlock { uvec4 photons[]; };
layout(set = 0, binding = 4) buffer DroppedBlock { uint dropped[]; };

layout(push_constant, scalar) uniform Push {
    uint landed_stage;
    uint first;     // place of the turn's first photon
    uint capacity;  // of a turn
} push;

const float MOST = 1e30;

bool is_sound(Photon photon) {
    return all(lessThan(abs(photon.position_rs), vec3(MOST))) && all(greaterThanEqual(photon.flux, vec3(0.0)))
        && all(lessThan(photon.flux, vec3(MOST)));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.capacity) {
        return;
    }
    uvec4 place = uvec4(0u);
    uvec4 carried = uvec4(0u);
    uvec4 ellipse = uvec4(0u);
    if (index < texelFetch(counts, int(push.landed_stage * STAGE_WORDS + COUNT_WORD)).x) {
        Photon photon = load_photon(landed, index);
        vec4 smaller = texelFetch(ellipses, int(index));
        bool is_number = is_finite(photon.position_rs) && is_finite(photon.flux) && is_finite(photon.radius) && is_finite(smaller);
        if (!is_number) {
            atomicAdd(dropped[0], 1u);
        } else if (is_sound(photon)) {
            place = texelFetch(landed, 2 * int(index));
            carried = texelFetch(landed, 2 * int(index) + 1);
            // A circle has no direction: any will do.
            ellipse.x = pack_direction(dot(smaller.xyz, smaller.xyz) > 0.5 ? smaller.xyz : vec3(1.0, 0.0, 0.0));
            ellipse.y = floatBitsToUint(smaller.w);
        }
    }
    uint first = 3u * (push.first + index);
    photons[first] = place;
    photons[first + 1u] = carried;
    photons[first + 2u] = ellipse;
}
