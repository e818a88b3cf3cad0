// The scene as rays meet it: triangles in render space, the attributes of their corners, textures as plain texels.
// The host flattens instances, so that a hit needs no transform (src/frame/rays/traced_scene.rs).
#ifndef LIB_TRACED_SCENE
#define LIB_TRACED_SCENE

#include "lib/scene.glsl"
#include "lib/vectors.glsl"

const uint TRIANGLE_FLAT = 0x80000000u;  // no vertex normals

// What every hit needs of a triangle lies together, in four texels (rgba32ui), corners counter-clockwise as seen from the front:
//
//   corner 0          | material and TRIANGLE_FLAT
//   edge to corner 1  | normal at corner 0           normals: packed directions
//   edge to corner 2  | normal at corner 1
//   normal at corner 2 | mean density of points that next-event estimation takes on it, 1/m² | its cells: first texel, number an edge
//
// Behind the triangles lie the cells of those whose points are not drawn evenly (lib/emissive_cells.glsl).
// Lists of corners (texture coordinates, colors, tangents) hold three elements a triangle.
struct Triangle {
    vec3 origin;
    vec3 edge1;
    vec3 edge2;
    uint material;
    bool flat_normals;
    uvec3 normals;
    float light_density;
    uvec2 cells;
    int first_corner;
};

Triangle load_triangle(usamplerBuffer triangles, uint index) {
    int first = 4 * int(index);
    uvec4 a = texelFetch(triangles, first);
    uvec4 b = texelFetch(triangles, first + 1);
    uvec4 c = texelFetch(triangles, first + 2);
    uvec4 d = texelFetch(triangles, first + 3);
    return Triangle(
        uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz), a.w & ~TRIANGLE_FLAT,
        (a.w & TRIANGLE_FLAT) != 0u, uvec3(b.w, c.w, d.x), uintBitsToFloat(d.y), d.zw, 3 * int(index));
}

// An attribute at a point of the triangle with the weights of its corners.
vec4 interpolated(samplerBuffer corners, Triangle triangle, vec3 weights) {
    return weights.x * texelFetch(corners, triangle.first_corner) + weights.y * texelFetch(corners, triangle.first_corner + 1)
           + weights.z * texelFetch(corners, triangle.first_corner + 2);
}

vec3 front_normal(Triangle triangle) {
    return normalize_or(cross(triangle.edge1, triangle.edge2), vec3(0.0, 0.0, 1.0));
}

#endif
