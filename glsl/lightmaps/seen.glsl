// The light at a point that the eye or a mirror's ray sees.
#ifndef LIGHTMAPS_SEEN
#define LIGHTMAPS_SEEN

#include "lib/seen_triangle.glsl"
#include "lib/traced_scene.glsl"
#include "lightmaps/lookup.glsl"

// Cosine to the normal of what is seen, below which a triangle shows its back. At a silhouette the ray may meet a neighbour instead, edge-on.
const float BACK_COSINE = -0.5;

// The irradiance that light maps hold for it, W/m². `normal`: of the triangle, on the viewer's side.
vec3 seen_irradiance(vec3 position, vec3 normal, vec3 to_viewer, float distance, samplerBuffer light) {
    Hit hit = seen_hit(position, normal, to_viewer, distance);
    if (hit.triangle == NO_TRIANGLE) {
        return vec3(0.0);
    }
    vec3 face = front_normal(load_triangle(triangles, hit.triangle));
    bool back = dot(face, normal) < BACK_COSINE;
    return light_of(texels_at(hit.triangle, hit.barycentric, back, position, back ? -face : face), light, 0u);
}

#endif
