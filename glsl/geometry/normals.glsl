// The normals of a fragment.
#ifndef GEOMETRY_NORMALS
#define GEOMETRY_NORMALS

#include "geometry/interpolated.glsl"
#include "groups/geometry.glsl"
#include "lib/vectors.glsl"

vec3 vertex_position(uint vertex) {
    int first = 3 * int(vertex);
    return vec3(
        texelFetch(positions, first).x, texelFetch(positions, first + 1).x, texelFetch(positions, first + 2).x);
}

// `first_vertex`: the triangle's own, whose number among the primitive's vertices is that of the triangle (src/frame/drawn_triangles.rs).
uvec3 corners_of_triangle(Instance instance, uint first_vertex) {
    uint offset = uint(instance.vertex_offset);
    int first = int(instance.first_index + 3u * (first_vertex - offset));
    return uvec3(first_vertex, texelFetch(indices, first + 1).x + offset, texelFetch(indices, first + 2).x + offset);
}

// The normal of the triangle, exact however small it is on the screen, where screen-space derivatives of a position are noise.
// Eleven fetches a fragment, for primitives with vertex normals too: light views and shadows need the plane that was rasterised.
vec3 face_normal(Instance instance, uint first_vertex) {
    uvec3 corners = corners_of_triangle(instance, first_vertex);
    vec3 origin = vertex_position(corners.x);
    vec3 normal = cross(vertex_position(corners.y) - origin, vertex_position(corners.z) - origin);
    return transform_normal(instance, normal);
}

struct Normals {
    vec3 vertex;     // interpolated; sides with the surface's front
    vec3 geometric;  // sides with the viewer
};

// The cofactor transform makes normals follow the winding on the screen, so a front-facing triangle's points to the viewer.
Normals fragment_normals(Instance instance, vec3 vertex_normal, uint first_vertex, bool front_facing) {
    vec3 face = face_normal(instance, first_vertex);
    bool flat_normals = (instance.flags & INSTANCE_FLAT_NORMALS) != 0u;
    vec3 interpolated = flat_normals ? face : transform_normal(instance, normal_of_fragment(vertex_normal, vec3(0.0)));
    float viewer_side = front_facing ? 1.0 : -1.0;
    float outside = (instance.flags & INSTANCE_FLIPPED) != 0u ? -1.0 : 1.0;
    vec3 geometric = viewer_side * normalize_or(face, vec3(0.0, 0.0, 1.0));
    return Normals(outside * normalize_or(interpolated, geometric), geometric);
}

// A shading normal on the viewer's side of the surface. The triangle decides which side that is: an interpolated normal that
// leans away from the viewer at a silhouette stays as it is, since its mirror image would be lit from the wrong side.
vec3 towards_viewer(vec3 shading_normal, Normals normals) {
    return dot(normals.vertex, normals.geometric) < 0.0 ? -shading_normal : shading_normal;
}

#endif
