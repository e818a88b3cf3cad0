// Virtual point lights in a buffer of two texels each, read as a texel buffer (rgba32f):
//   [2k]     position_rs, A/π
//   [2k + 1] Φ/(π·s), the normal octahedrally in the bits of a float
// where s is the length of the unnormalised octahedral vector: whoever sums over many lights uses that vector as it is.
#ifndef LIB_VPL
#define LIB_VPL

#include "lib/octahedral.glsl"
#include "lib/vectors.glsl"

struct Vpl {
    vec3 position_rs;
    float area_over_pi;  // m²
    vec3 strength;       // reflected flux/π [W/sr], divided by |normal|
    vec3 normal;         // not of unit length
};

vec4 pack_vpl_position(vec3 position_rs, float area) {
    return vec4(position_rs, max(area * INVERSE_PI, 1e-16));
}

vec4 pack_vpl_strength(vec3 flux, vec3 normal) {
    float word = pack_direction_in_float(normal);
    return vec4(flux * (INVERSE_PI / length(unpack_direction_in_float_unnormalized(word))), word);
}

Vpl unpack_vpl(vec4 first, vec4 second) {
    return Vpl(first.xyz, first.w, second.rgb, unpack_direction_in_float_unnormalized(second.w));
}

// Where rays from or to a VPL start or end, on the side that its normal points to. A light view knows a surface to a small share of a texel, and a
// VPL's disc has at least one: a thousandth of its radius. 64 units in the last place more are for its own rounding.
vec3 lifted_vpl(Vpl vpl) {
    vec3 size = abs(vpl.position_rs);
    float lift = sqrt(vpl.area_over_pi) * exp2(-10.0) + exp2(-18.0) * max(size.x, max(size.y, size.z));
    return vpl.position_rs + lift * normalize(vpl.normal);
}

// The factor of `strength` in the irradiance at x, with D = y − x and ω = D/|D|:
//
//   E(x) = Φ/π · (n_y·−ω)⁺ (n_x·ω)⁺ / (D² + A/π)      written as      strength · (n_y·−D)⁺ (n_x·D)⁺ / (D²(D² + A/π))
//
// A Lambertian disc of area A = πR² and radiance L sends Φ = πLA; on its axis, at distance d, the irradiance is
// πL·R²/(R² + d²) = Φ/(πd² + A) = Φ/π / (d² + A/π). Off the axis the cosines are a point's. Reich 2015, eq. 4.4
// (after Lensing & Broll 2013), prints d² + A, which darkens the near field by up to π. Bounded by strength/(A/π): no singularity, no tuned constant.
float vpl_form_factor(Vpl vpl, vec3 position_rs, vec3 normal) {
    vec3 difference = vpl.position_rs - position_rs;
    float squared = dot(difference, difference) + 1e-20;
    float cosines = max(-dot(vpl.normal, difference), 0.0) * max(dot(normal, difference), 0.0);
    return cosines / (squared * (squared + vpl.area_over_pi));
}

#endif
