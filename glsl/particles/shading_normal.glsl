// The normal of shading at a point of a triangle, on the side of `face`.
#ifndef PARTICLES_SHADING_NORMAL
#define PARTICLES_SHADING_NORMAL

#include "lib/octahedral.glsl"
#include "lib/traced_scene.glsl"

vec3 shading_normal(Triangle triangle, vec2 place, vec3 face) {
    if (triangle.flat_normals) {
        return face;
    }
    vec3 weights = vec3(1.0 - place.x - place.y, place);
    vec3 normal = normalize_or(
        weights.x * unpack_direction(triangle.normals.x) + weights.y * unpack_direction(triangle.normals.y)
            + weights.z * unpack_direction(triangle.normals.z), face);
    return dot(normal, face) < 0.0 ? -normal : normal;
}

#endif
