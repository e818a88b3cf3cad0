// What a gathering texel sees where a ray from it, or the middle of a fragment of its hemicube, meets a surface: what its diffuse lobe sends back of the AIM. What
// emits, and what specular lobes send, belongs to other slots.
#ifndef LIGHTMAPS_GATHERED
#define LIGHTMAPS_GATHERED

#include "lib/hit_albedo.glsl"
#include "lightmaps/lookup.glsl"

// L = (ρ/π)·E_AIM(y), W/(m²·sr).
vec3 radiance_of_hit(Hit hit, vec3 origin, vec3 direction, samplerBuffer received) {
    Triangle triangle = load_triangle(triangles, hit.triangle);
    vec3 albedo = albedo_of_hit(triangle, hit);
    if (max3(albedo) <= 0.0) {
        return vec3(0.0);
    }
    vec3 face = front_normal(triangle);
    bool back = dot(face, direction) > 0.0;
    vec3 position = point_of_hit(triangle, hit.barycentric, face, origin, hit.distance * direction);
    Cell cell = texels_at(hit.triangle, hit.barycentric, back, position, back ? -face : face);
    return albedo * INVERSE_PI * light_of(cell, received);
}

#endif
