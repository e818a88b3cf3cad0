#version 460
#include "lib/prelude.glsl"
#include "photons/field.glsl"
#include "photons/kept.glsl"

// Readies one photon that landed for the points that it lights, and counts it in the bucket of its cell (photons/field.glsl). Its ellipse is about as wide as a pixel shows
// of surfaces where it lies, or wider: narrower ones would slip between the points. Mirrors show things at least as far away as they are, so that this is the least
// that a pixel of a flat one shows.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer kept;  // photons/kept.glsl
layout(set = 0, binding = 1) writeonly buffer PhotonBlock { uvec4 photons[]; };
layout(set = 0, binding = 2) writeonly buffer BucketBlock { uint buckets[]; };
layout(set = 0, binding = 3) buffer CountBlock { uint counts[]; };
layout(set = 0, binding = 4) buffer StateBlock { uint state[]; };

layout(push_constant, scalar) uniform Push {
    vec3 shift;           // from render space to that of rays
    uint count;
    vec3 eye;             // in the rays' space
    float pixel_angle;    // metres across a pixel at a distance of one
    float pixel_extent;   // metres across a pixel at any distance
    float radius;         // of all photons, m; 0: each has its own ellipse
    float radius_scale;   // of its radii
    float coarsest;       // side of a cell, m
    float tolerance;      // metres that a photon may be off its surface
    uint bucket_mask;
} push;

// A Gaussian that ends there has a deviation of half a pixel: over points a pixel apart its sum is off by 1 %.
const float LEAST_PIXELS = 1.5;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.count) {
        return;
    }
    KeptPhoton photon = load_kept(kept, index);
    if (max3(photon.flux) <= 0.0) {
        buckets[index] = NO_BUCKET;
        return;
    }
    vec3 position = photon.position_rs + push.shift;
    float least = LEAST_PIXELS * max(push.pixel_extent, push.pixel_angle * distance(position, push.eye));
    vec2 radii = push.radius > 0.0 ? vec2(push.radius) : push.radius_scale * vec2(photon.larger, photon.smaller);
    float larger = min(max(radii.x, least), 0.5 * push.coarsest);
    float smaller = min(max(radii.y, least), larger);
    vec3 squeeze = photon.narrow_axis * sqrt(max(1.0 / (smaller * smaller) - 1.0 / (larger * larger), 0.0));
    vec3 irradiance = min(photon.flux * (gaussian_peak() / (larger * smaller)), vec3(1e30));
    uint level = level_of(max(larger, push.tolerance), push.coarsest);
    photons[FIELD_TEXELS * index] = uvec4(floatBitsToUint(position), level);
    photons[FIELD_TEXELS * index + 1u] = uvec4(floatBitsToUint(irradiance), floatBitsToUint(1.0 / (larger * larger)));
    photons[FIELD_TEXELS * index + 2u] = uvec4(floatBitsToUint(squeeze), pack_direction(photon.normal));
    uint bucket = bucket_of_cell(cell_of(position, level, 1.0 / push.coarsest), level, push.bucket_mask);
    buckets[index] = bucket;
    atomicAdd(counts[bucket], 1u);
    atomicOr(state[STATE_LEVELS], 1u << level);
    // Bits of positive floats have the order of the floats.
    atomicMax(state[STATE_PEAK], floatBitsToUint(max3(irradiance)));
    atomicAdd(state[STATE_PHOTONS], 1u);
}
