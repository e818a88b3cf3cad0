// What a gathering texel sees where a ray from it, or the middle of a fragment of its hemicube, meets a surface: what its diffuse lobe sends back of the AIM. What
// emits, and what specular lobes send, belongs to other slots.
#ifndef LIGHTMAPS_GATHERED
#define LIGHTMAPS_GATHERED

#include "lib/hit_albedo.glsl"
#include "lightmaps/lookup.glsl"

// Whether there is such a lobe: its albedo over π, and the texels around, so that L = (ρ/π)·E_AIM(y), W/(m²·sr), is `lobe` times their light.
bool sends_light_back(Hit hit, vec3 origin, vec3 direction, out vec3 lobe, out Cell cell) {
    Triangle triangle = load_triangle(triangles, hit.triangle);
    lobe = INVERSE_PI * albedo_of_hit(triangle, hit);
    if (max3(lobe) <= 0.0) {
        return false;
    }
    vec3 face = front_normal(triangle);
    bool back = dot(face, direction) > 0.0;
    vec3 position = point_of_hit(triangle, hit.barycentric, face, origin, hit.distance * direction);
    cell = texels_at(hit.triangle, hit.barycentric, back, position, back ? -face : face);
    return true;
}

#endif
