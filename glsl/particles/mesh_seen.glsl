// The subtriangle at a point that the eye or a mirror's ray sees (lib/seen_triangle.glsl), which is marked (Chang et al. 4.3). The including file has
// `buffer Marks { uint marks[]; }` and binds `tessellation`.

#include "lib/seen_triangle.glsl"
#include "particles/mesh_spots.glsl"
#include "particles/mesh_tessellation.glsl"

// Cosine from which rounding decides which side one sees.
const float EDGE_ON_SIDE = 0.02;

// `to_viewer`: unit, the viewer `distance` away; `normal`: of the triangle.
uvec4 seen_subtriangle(vec3 position, vec3 normal, vec3 to_viewer, float distance) {
    Hit hit = seen_hit(position, normal, to_viewer, distance);
    if (hit.triangle == NO_TRIANGLE) {
        return NOTHING_SEEN;
    }
    Tessellated t = load_tessellated(hit.triangle);
    if (!has_radiance_particles(t)) {
        return NOTHING_SEEN;
    }
    float facing = dot(front_normal(load_triangle(triangles, hit.triangle)), to_viewer);
    uint sides = sides_of(t);
    if (sides == 1u && facing < -EDGE_ON_SIDE) {
        return NOTHING_SEEN;
    }
    uint side = sides == 2u && facing < 0.0 ? 1u : 0u;
    Subtriangle seen = subtriangle_at(t, hit.barycentric);
    uint number = t.first_subtriangle + sides * seen.index + side;
    uint bit = 1u << (number & 31u);
    if ((marks[number >> 5] & bit) == 0u) {
        atomicOr(marks[number >> 5], bit);
    }
    return uvec4(2u * hit.triangle + side, seen.index, packUnorm2x16(seen.weights.yz), number);
}
