// How a surface scatters: glTF 2.0 appendix B with KHR_materials_ior, _specular and _transmission.
//
//   f(l, v) = diffuse_albedo/π · (1 − max F)  +  F · D · V            [1/sr]
//   F = f0 + (f90 − f0)(1 − v·h)⁵                                     Schlick 1994
//   D = α²/(π((n·h)²(α² − 1) + 1)²), α = roughness²                   GGX, Walter et al. 2007
//   V = G/(4 n·l n·v), G the height-correlated Smith term             Heitz 2014
//
// A dielectric has f0 = min(((ior−1)/(ior+1))²·specular_color, 1)·specular and f90 = specular, a metal f0 = base color and f90 = 1;
// `metallic` mixes the two. Transmission takes its share from the diffuse lobe, as does metallic.
#ifndef LIB_BRDF
#define LIB_BRDF

#include "lib/scene.glsl"
#include "lib/vectors.glsl"

// α below this is a mirror to a pixel but a spike beyond the range of floats.
const float MINIMUM_ALPHA = 1e-3;

// A material at one point: its factors times its textures and vertex colors.
struct MaterialPoint {
    vec4 base_color;
    vec3 emissive;
    vec3 specular_color;
    float specular;
    float metallic;
    float roughness;
    float transmission;
};

MaterialPoint material_factors(Material material, vec4 vertex_color) {
    return MaterialPoint(
        material.base_color * vertex_color, material.emissive, material.specular_color, material.specular,
        material.metallic, material.roughness, material.transmission);
}

struct Lobes {
    vec3 diffuse_albedo;
    vec3 f0;
    float f90;
    float roughness;
};

Lobes lobes_of_material(Material material, MaterialPoint point) {
    float root_f0 = (material.ior - 1.0) / (material.ior + 1.0);
    vec3 dielectric_f0 = min(root_f0 * root_f0 * point.specular_color, vec3(1.0)) * point.specular;
    Lobes lobes;
    lobes.diffuse_albedo = point.base_color.rgb * ((1.0 - point.metallic) * (1.0 - point.transmission));
    lobes.f0 = mix(dielectric_f0, point.base_color.rgb, point.metallic);
    lobes.f90 = mix(point.specular, 1.0, point.metallic);
    lobes.roughness = point.roughness;
    if ((material.flags & MATERIAL_UNLIT) != 0u) {
        lobes.diffuse_albedo = vec3(0.0);
        lobes.f0 = vec3(0.0);
        lobes.f90 = 0.0;
    }
    return lobes;
}

// Radiance that the surface sends out by itself, from one side unless the material is double-sided. An unlit surface shows its color.
vec3 emitted_radiance(Material material, MaterialPoint point, bool front) {
    if ((material.flags & MATERIAL_UNLIT) != 0u) {
        return point.base_color.rgb;
    }
    return front || (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? point.emissive : vec3(0.0);
}

struct Surface {
    vec3 position_rs;
    vec3 normal;            // shading normal, on the viewer's side
    vec3 geometric_normal;  // of the triangle, on the viewer's side
    vec3 diffuse_albedo;
    vec3 f0;
    float f90;
    float roughness;
};

vec3 schlick_fresnel(vec3 f0, float f90, float cosine) {
    float one_minus = clamp(1.0 - cosine, 0.0, 1.0);
    float squared = one_minus * one_minus;
    return f0 + (vec3(f90) - f0) * (squared * squared * one_minus);
}

// The diffuse lobe under its specular layer, for the half vector's cosine v·h. [1/sr]
vec3 diffuse_brdf(Surface surface, float v_dot_h) {
    return surface.diffuse_albedo * (INVERSE_PI * (1.0 - max3(schlick_fresnel(surface.f0, surface.f90, v_dot_h))));
}

// F·D·V. The denominator of D is written with |n×h|² = 1 − (n·h)², which does not cancel near the peak. [1/sr]
vec3 specular_brdf(Surface surface, vec3 to_light, vec3 to_eye) {
    vec3 middle = normalize_or(to_light + to_eye, surface.normal);
    float n_dot_l = max(dot(surface.normal, to_light), 1e-4);
    float n_dot_v = max(dot(surface.normal, to_eye), 1e-4);
    float n_dot_h = clamp(dot(surface.normal, middle), 0.0, 1.0);
    float alpha = max(surface.roughness * surface.roughness, MINIMUM_ALPHA);
    float alpha2 = alpha * alpha;
    vec3 across = cross(surface.normal, middle);
    float spread = alpha2 * n_dot_h * n_dot_h + dot(across, across);
    float distribution = alpha2 / (PI * spread * spread);
    float visibility = 0.5 / (n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - alpha2) + alpha2)
                              + n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - alpha2) + alpha2));
    return schlick_fresnel(surface.f0, surface.f90, dot(to_eye, middle)) * (distribution * visibility);
}

// Both lobes. [1/sr]
vec3 surface_brdf(Surface surface, vec3 to_light, vec3 to_eye) {
    vec3 middle = normalize_or(to_light + to_eye, surface.normal);
    return diffuse_brdf(surface, dot(to_eye, middle)) + specular_brdf(surface, to_light, to_eye);
}

// The share of diffuse irradiance that the diffuse lobe sends back when neither direction is known: what a virtual point
// light reflects, and what a receiver of indirect light answers with. The specular layer above takes the mean of F(v·h) over both
// directions, cosine-weighted: f0 + (f90 − f0)·<(1 − v·h)⁵>, <(1 − v·h)⁵> = 0.003685, since the half vector is never far from either
// direction; the brightest channel's, as the BRDF does.
const float MEAN_HALF_FRESNEL = 0.003685;

vec3 indirect_diffuse_albedo(vec3 diffuse_albedo, vec3 f0, float f90) {
    float mean_fresnel = max3(mix(f0, vec3(f90), MEAN_HALF_FRESNEL));
    return diffuse_albedo * (1.0 - mean_fresnel);
}

vec3 indirect_diffuse_albedo(Surface surface) {
    return indirect_diffuse_albedo(surface.diffuse_albedo, surface.f0, surface.f90);
}

#endif
