#version 460
#include "lib/prelude.glsl"
#include "photon_lists/line.glsl"

// One texel of a photon's line: what the ray meets of the texel's list (Quyen 2014, alg. 3.5; the test itself is photon_lists/hit.glsl's). The
// paper writes each line into a row of a texture and takes the row's first hit; here the nearest is an atomic minimum of the distance, in m.
// Depths come from the ray, not from interpolation along the line.

layout(set = 0, binding = 1) buffer Hits { uint hits[]; };

layout(location = 0) flat in uint ray_index;

// Nothing that the test finds in the column is left out for rounding.
const float WIDENED_COLUMN = 1.01 * LINE_COLUMN;

void main() {
    uvec2 cell = uvec2(gl_FragCoord.xy);
    uint row = push.view_index * push.resolution + cell.y;
    uvec4 list = texelFetch(list_pixels, int(row * push.resolution + cell.x));
    if (list.x != NO_NODE) {
        ListView view = load_list_view(list_views, push.view_index);
        PhotonRay ray = load_photon_ray(rays, ray_index);
        ViewRay along = view_ray(view, ray);
        vec2 center = vec2(cell) + 0.5;
        // Where the ray is beside the texel's centre, and how far it is from there to the ends of its column.
        vec2 crossing = (center * along.start.z - along.start.xy) / (along.step.xy - center * along.step.z);
        vec2 speed = abs(along.step.xy - center * along.step.z);
        float t = speed.x > speed.y ? crossing.x : crossing.y;
        float reach = 2.0 * LINE_COLUMN * (along.start.z + t * along.step.z) / max(speed.x, speed.y);
        vec2 depths = along.depth + vec2(t - reach, t + reach) * along.depth_step;
        uint known = hits[4u * ray_index];
        // A ray along the column is in it all the way: neither time nor depth tells it from the list.
        bool passes = is_finite(depths) && is_finite(t - reach);
        bool beyond = min(depths.x, depths.y) > uintBitsToFloat(~list.z) || max(depths.x, depths.y) < uintBitsToFloat(list.y);
        // What is nearer than the hit that is known is found whichever is known first: the way through the column is exact, and all of it before the eye.
        int axis = speed.x > speed.y ? 0 : 1;
        vec2 sides = center[axis] + vec2(-WIDENED_COLUMN, WIDENED_COLUMN);
        vec2 ends = (sides * along.start.z - along.start[axis]) / (along.step[axis] - sides * along.step.z);
        bool bounded = is_finite(ends) && along.start.z + min(ends.x * along.step.z, ends.y * along.step.z) > 0.0;
        bool behind = known != HIT_NONE && bounded && min(ends.x, ends.y) > uintBitsToFloat(known);
        if (!passes || (!beyond && !behind)) {
            Column column = column_of(view, center);
            float nearest = NO_HIT_DISTANCE;
            uint index = list.x;
            FOR_NODES_OF_LIST(index) {
                uvec4 node = texelFetch(list_nodes, int(index));
                nearest = min(nearest, distance_to_node(node, view, column, center, LINE_COLUMN, along, ray));
                index = node.z;
            }
            if (nearest < NO_HIT_DISTANCE) {
                atomicMin(hits[4u * ray_index], floatBitsToUint(nearest));
            }
        }
    }
}
