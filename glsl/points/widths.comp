#version 460
#include "lib/prelude.glsl"
#include "points/fixed_point.glsl"
#include "points/landing_place.glsl"
#include "points/width.glsl"

// Adds how wide the light of one photon is to the pixel that it falls on: Σ Φ·C/R² of the mean channel, C its ellipse (points/width.glsl) and R the largest radius that
// there is at the pixel. xy may be negative: 1/2 is added.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) uniform usamplerBuffer fluxes;
layout(set = 0, binding = 2, r32ui) uniform uimage2D width_xx;
layout(set = 0, binding = 3, r32ui) uniform uimage2D width_yy;
layout(set = 0, binding = 4, r32ui) uniform uimage2D width_xy;

layout(push_constant, scalar) uniform Push {
    ivec2 size;
    uint count;
    uint count_log2;
    float radius;        // of all photons, m; 0: each has its own ellipse
    float radius_scale;  // of its radii
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
    float most = float(MOST_REACH) * place.extent;
    vec3 shares = width_of(photon, place.normal, place.extent, push.radius, push.radius_scale) / (most * most) + vec3(0.0, 0.0, 0.5);
    float mean = (photon.flux.x + photon.flux.y + photon.flux.z) * (1.0 / 3.0);
    float scale = fixed_point_scale(fluxes, push.count_log2);
    uvec3 terms = fixed_point(mean * clamp(shares, 0.0, 1.0), scale, chance_of(photon.position_rs));
    imageAtomicAdd(width_xx, pixel, terms.x);
    imageAtomicAdd(width_yy, pixel, terms.y);
    imageAtomicAdd(width_xy, pixel, terms.z);
}
