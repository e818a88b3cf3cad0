// From where the radiance particles of each subtriangle that is seen look for light (mesh_fit.comp), by threes: a point and 1 if the particle has a list; where light may
// be interpolated all over the subtriangle the first one has INTERPOLATES in place of 1. Elsewhere a point reads those particles that it sees itself. The including
// file binds `subtriangle_marks` and `marked_before`, has `buffer Views { vec4 views[]; }` and `buffer Counts { uint counts[]; }` (points that read some of
// the three, points that read none), and includes lib/bvh.glsl.

#include "particles/mesh_found.glsl"
#include "particles/mesh_slot.glsl"
#include "particles/mesh_spots.glsl"

// A share of the three weights that is none.
const float NO_WEIGHT = 1e-3;

// The spot as it is read; NOTHING_SEEN where none of its radiance particles is. `from`: above the spot.
uvec4 read_spot(uvec4 spot, vec3 from) {
    if (spot.x == NO_SPOT) {
        return spot;
    }
    uint first = 3u * place_among_marked(subtriangle_marks, marked_before, spot.w);
    if (views[first].w == INTERPOLATES) {
        return spot;
    }
    vec3 weights = weights_of_spot(spot);
    [[dont_unroll]] for (uint point = 0u; point < 3u; ++point) {
        vec4 seen = views[first + point];
        if (weights[point] > 0.0 && (seen.w == 0.0 || is_occluded(from, seen.xyz - from, 1.0))) {
            weights[point] = 0.0;
        }
    }
    float sum = weights.x + weights.y + weights.z;
    if (sum < NO_WEIGHT) {
        return NOTHING_SEEN;
    }
    atomicAdd(counts[0], 1u);
    return uvec4(spot.xy, packUnorm2x16(weights.yz / sum), spot.w);
}
