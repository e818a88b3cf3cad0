// The subtriangle at a point that the eye or a mirror's ray sees, which is marked (Chang et al. 4.3). Neither says which triangle that is; a ray over a small
// part of the way knows, whatever rounding did to the point: nothing stands before it. The including file has `buffer Marks { uint marks[]; }` and binds
// `tessellation`.

#include "particles/mesh_spots.glsl"
#include "particles/mesh_tessellation.glsl"

// Shares of the distance: how far before the point the ray begins, and how far beside it the next one goes where a silhouette's rounding hid the surface.
const float BEFORE = 1.0 / 64.0;
const float BESIDE = 1.0 / 4096.0;
// Cosine from which rounding decides which side one sees.
const float EDGE_ON_SIDE = 0.02;

// `to_viewer`: unit, the viewer `distance` away; `normal`: of the triangle.
uvec4 seen_subtriangle(vec3 position, vec3 normal, vec3 to_viewer, float distance) {
    Hit hit = Hit(0.0, vec2(0.0), NO_TRIANGLE);
    vec3 aside = normalize_or(cross(to_viewer, normal), vec3(0.0));
    vec3 across = cross(aside, to_viewer);
    [[dont_unroll]] for (uint attempt = 0u; attempt < 5u && hit.triangle == NO_TRIANGLE; ++attempt) {
        vec3 way = (attempt & 1u) == 0u ? across : aside;
        vec3 beside = attempt == 0u ? vec3(0.0) : way * (attempt < 3u ? BESIDE : -BESIDE) * distance;
        hit = closest_hit(position + beside + to_viewer * (BEFORE * distance), -to_viewer, 2.0 * BEFORE * distance);
    }
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
