#version 460
#include "lib/prelude.glsl"
#include "points/fixed_point.glsl"
#include "points/landing_place.glsl"

// Adds where one photon lies in its pixel: Σ Φ·x and Σ Φ·y of the mean channel, x and y in [0, 1]. Photons of neighbouring pixels lie on a lattice, and even light is
// the sum of theirs only if they are not moved to the pixels' middles.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) uniform usamplerBuffer fluxes;
layout(set = 0, binding = 2, r32ui) uniform uimage2D shift_x;
layout(set = 0, binding = 3, r32ui) uniform uimage2D shift_y;

layout(push_constant, scalar) uniform Push {
    ivec2 size;
    uint count;
    uint count_log2;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.count || max3(flux_of_kept(photons, index)) <= 0.0) {
        return;
    }
    KeptPhoton photon = load_kept(photons, index);
    ivec2 pixel;
    Place place;
    if (!lands_in_view(photon, push.size, pixel, place)) {
        return;
    }
    vec2 inside = clamp(image_place(photon.position_rs, push.size) - vec2(pixel), 0.0, 1.0);
    float mean = (photon.flux.x + photon.flux.y + photon.flux.z) * (1.0 / 3.0);
    float scale = fixed_point_scale(fluxes, push.count_log2);
    uvec3 terms = fixed_point(mean * vec3(inside, 0.0), scale, chance_of(photon.position_rs));
    imageAtomicAdd(shift_x, pixel, terms.x);
    imageAtomicAdd(shift_y, pixel, terms.y);
}
