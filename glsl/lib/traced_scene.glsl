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
//   normal at corner 2 | mean density of points that next-event estimation takes on it, 1/m² | distance of its plane from the origin | its cells
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
    float plane;  // n·x of its points, m
    uint cells;   // cells an edge, 7 bits, and texels from the first of them to the list's end, 25 bits; 0: none
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
        (a.w & TRIANGLE_FLAT) != 0u, uvec3(b.w, c.w, d.x), uintBitsToFloat(d.y), uintBitsToFloat(d.z), d.w, 3 * int(index));
}

// An attribute at a point of the triangle with the weights of its corners.
vec4 interpolated(samplerBuffer corners, Triangle triangle, vec3 weights) {
    return weights.x * texelFetch(corners, triangle.first_corner) + weights.y * texelFetch(corners, triangle.first_corner + 1)
           + weights.z * texelFetch(corners, triangle.first_corner + 2);
}

vec3 front_normal(Triangle triangle) {
    return normalize_or(cross(triangle.edge1, triangle.edge2), vec3(0.0, 0.0, 1.0));
}

float size_of(Triangle triangle) {
    vec3 size = max(abs(triangle.origin), max(abs(triangle.edge1), abs(triangle.edge2)));
    return max(size.x, max(size.y, size.z));
}

// Rounding moves a sum of corners off their plane by as much as the corners are far; the plane is known as well as the point itself is near the
// origin. Of slivers it is not: they are moved by no more than the sum's rounding.
vec3 point_on_plane(Triangle triangle, vec3 point, vec3 normal) {
    float most = exp2(-21.0) * size_of(triangle);
    return point + normal * clamp(triangle.plane - dot(normal, point), -most, most);
}

// The point with these weights of corners 1 and 2. `normal`: front_normal().
vec3 point_of_triangle(Triangle triangle, vec2 place, vec3 normal) {
    return point_on_plane(triangle, triangle.origin + place.x * triangle.edge1 + place.y * triangle.edge2, normal);
}

// The same where a ray met it: of a triangle that is much larger than the ray is long, the ray knows better which point that is.
vec3 point_of_hit(Triangle triangle, vec2 place, vec3 normal, vec3 origin, vec3 way) {
    vec3 size = abs(origin) + abs(way);
    if (16.0 * max(size.x, max(size.y, size.z)) < size_of(triangle)) {
        return point_on_plane(triangle, origin + way, normal);
    }
    return point_of_triangle(triangle, place, normal);
}

#endif
