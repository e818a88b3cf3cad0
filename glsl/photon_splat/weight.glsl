// What a photon's disc gives to a point (photon_splat/disc.glsl).
#ifndef PHOTON_SPLAT_WEIGHT
#define PHOTON_SPLAT_WEIGHT

#include "photon_splat/kernel.glsl"

// One instruction a component, which the compiler may not choose by itself.
float fused_dot(vec3 a, vec3 b) {
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}

// The share of texel 1's irradiance that a point with a normal gets. `offset`: from the disc's centre.
float disc_weight(
    vec3 offset, vec3 normal, vec3 disc_normal, float inverse_squared_radius, vec3 squeeze, float height_limit) {
    float cosine = fused_dot(normal, disc_normal);
    float height = fused_dot(offset, disc_normal);
    float squared = max(fma(-height, height, fused_dot(offset, offset)) * inverse_squared_radius, 0.0);
    if (ELLIPTIC != 0u) {
        float squeezed = fused_dot(offset, squeeze);
        squared = fma(squeezed, squeezed, squared);
    }
    bool same_surface = cosine > LEAST_COSINE && abs(height) < height_limit;
    return same_surface ? kernel_shape(squared) * cosine : 0.0;
}

#endif
