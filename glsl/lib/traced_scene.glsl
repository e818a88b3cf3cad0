// The scene as rays meet it: triangles in render space, the attributes of their corners, textures as plain texels.
// The host flattens instances, so that a hit needs no transform (src/reference/traced_scene.rs).
#ifndef LIB_TRACED_SCENE
#define LIB_TRACED_SCENE

#include "lib/scene.glsl"
#include "lib/vectors.glsl"

const uint TRIANGLE_FLAT = 0x80000000u;  // no vertex normals

// Three texels (rgba32ui) with the corners, counter-clockwise as seen from the front, and one with the rest:
// corner 0 | material and TRIANGLE_FLAT · edge to corner 1 | number of corner 0 · edge to corner 2 | number of corner 1 ·
// number of corner 2 | density of points that next-event estimation takes on it, 1/m²
struct Triangle {
    vec3 origin;
    vec3 edge1;
    vec3 edge2;
    uint material;
    bool flat_normals;
    uvec3 corners;
    float light_density;
};

Triangle load_triangle(usamplerBuffer triangles, uint index) {
    int first = 4 * int(index);
    uvec4 a = texelFetch(triangles, first);
    uvec4 b = texelFetch(triangles, first + 1);
    uvec4 c = texelFetch(triangles, first + 2);
    uvec4 d = texelFetch(triangles, first + 3);
    return Triangle(
        uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz), a.w & ~TRIANGLE_FLAT,
        (a.w & TRIANGLE_FLAT) != 0u, uvec3(b.w, c.w, d.x), uintBitsToFloat(d.y));
}

vec3 front_normal(Triangle triangle) {
    return normalize_or(cross(triangle.edge1, triangle.edge2), vec3(0.0, 0.0, 1.0));
}

#endif
