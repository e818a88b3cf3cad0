#version 460
#include "lib/prelude.glsl"
#include "groups/photon_lists.glsl"
#include "lib/octahedral.glsl"
#include "photon_lists/node.glsl"
#include "photon_lists/slices.glsl"
#include "photon_lists/view.glsl"

// The slices that the surfaces in a block of 4×4 texels touch, each as its plane runs through the columns in which rays may meet it
// (photon_lists/hit.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Blocks { uvec4 blocks[]; };

layout(push_constant, scalar) uniform Push {
    uint resolution;
    uint view_count;
} push;

// A little more than MARCH_COLUMN, since slopes are rounded.
const float REACH = 0.8;

uvec4 slices_of_texel(ListView view, uint view_index, uvec2 texel) {
    Column column = column_of(view, vec2(texel) + 0.5);
    uvec4 found = uvec4(0u);
    uint row = view_index * push.resolution + texel.y;
    uint index = texelFetch(list_pixels, int(row * push.resolution + texel.x)).x;
    FOR_NODES_OF_LIST(index) {
        uvec4 node = texelFetch(list_nodes, int(index));
        vec3 normal = unpack_direction(node.y);
        float depth = uintBitsToFloat(node.x);
        float stretch = view.near > 0.0 ? depth : 1.0;
        float slope = (abs(dot(normal, view.across)) + abs(dot(normal, view.down))) * stretch;
        float reach = min(REACH * slope / max(abs(dot(normal, column.way)), 1e-20), view.far);
        float scale = SLICES / view.far;
        found |= slices_between((depth - reach) * scale - 0.01, (depth + reach) * scale + 0.01);
        index = node.z;
    }
    return found;
}

void main() {
    uint side = blocks_of_level(push.resolution, 1u);
    uint view_index = gl_GlobalInvocationID.x / (side * side);
    if (view_index < push.view_count) {
        uint within = gl_GlobalInvocationID.x - view_index * side * side;
        uvec2 first = uvec2(within % side, within / side) << LEVEL_BITS;
        uvec2 size = min(uvec2(4u), uvec2(push.resolution) - first);
        ListView view = load_list_view(list_views, view_index);
        uvec4 found = uvec4(0u);
        for (uint place = 0u; place < size.x * size.y; ++place) {
            found |= slices_of_texel(view, view_index, first + uvec2(place % size.x, place / size.x));
        }
        blocks[gl_GlobalInvocationID.x] = found;
    }
}
