// What a surface makes of caustic irradiance: radiance in W/(m²·sr) of its diffuse lobe, L = ρ/π·E. ρ = indirect_diffuse_albedo(), since the sum
// over photons does not tell where each came from.
#ifndef PHOTON_SPLAT_ANSWER
#define PHOTON_SPLAT_ANSWER

#include "lib/surface_packing.glsl"

vec3 answer(vec3 irradiance, uvec4 surface_texel, vec4 specular_texel) {
    Surface point = unpack_surface(vec3(0.0), surface_texel, specular_texel);
    return irradiance * indirect_diffuse_albedo(point) * INVERSE_PI;
}

#endif
