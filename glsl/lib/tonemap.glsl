// Tone curves: scene-referred linear radiance to display-referred linear values; the result still needs clamping and srgb_encode().
#ifndef LIB_TONEMAP
#define LIB_TONEMAP

#include "lib/color.glsl"

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": a rational fit, channel by channel. The cap keeps the squares finite.
vec3 tonemap_aces(vec3 color) {
    vec3 x = min(color, vec3(1e4));
    return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
}

// Drago et al. 2003, "Adaptive Logarithmic Mapping for Displaying High Contrast Scenes", eq. 4, with L_dmax = 100 cd/m²:
//   L_d = 1/log10(M + 1) · ln(L + 1)/ln(2 + 8·(L/M)^(ln b/ln 0.5))
// L and the maximum M in units of the world adaptation luminance, b the bias. Returns L_d/L, to multiply the color with.
float tonemap_drago_scale(float scaled_luminance, float scaled_maximum, float bias) {
    float l = max(scaled_luminance, 1e-6);
    float m = max(scaled_maximum, l);
    float exponent = log(bias) / log(0.5);
    float display = log(l + 1.0) / log(2.0 + 8.0 * pow(l / m, exponent)) * (log(10.0) / log(m + 1.0));
    return display / l;
}

#endif
