// The light of emissive surfaces that directions run into, and its weight against that of points drawn on them: the power heuristic (Veach & Guibas 1995).
#ifndef LIB_EMITTER_HITS
#define LIB_EMITTER_HITS

#include "lib/emissive_cells.glsl"
#include "lib/emissive_points.glsl"

// The weight of a sample that was drawn with `density`, where another one could have been drawn with `other`.
float power_heuristic(float density, float other) {
    float ratio = other / density;
    return 1.0 / (1.0 + ratio * ratio);
}

// What comes from a hit, weighted. `density` of the direction; `density_scale`: from a point's density among all lights to that among emissive triangles.
vec3 weighted_radiance(Hit hit, vec3 direction, float density, float density_scale) {
    Triangle triangle = load_triangle(triangles, hit.triangle);
    Material material = load_material(materials, triangle.material);
    float cosine = -dot(front_normal(triangle), direction);
    cosine = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? abs(cosine) : cosine;
    if (triangle.light_density <= 0.0 || cosine <= 0.0) {
        return vec3(0.0);
    }
    float other = emissive_density(triangle, hit.barycentric) * density_scale * hit.distance * hit.distance / max(cosine, 1e-9);
    return emissive_radiance(triangle, material, hit.barycentric) * power_heuristic(density, other);
}

#endif
