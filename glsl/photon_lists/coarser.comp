#version 460
#include "lib/prelude.glsl"
#include "photon_lists/slices.glsl"

// The slices that a block of 4×4 blocks of the finer level touches.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Blocks { uvec4 blocks[]; };

layout(push_constant, scalar) uniform Push {
    uint resolution;
    uint view_count;
    uint level;
    uint first;        // block of this level
    uint first_finer;
} push;

void main() {
    uint side = blocks_of_level(push.resolution, push.level);
    uint finer_side = blocks_of_level(push.resolution, push.level - 1u);
    uint view_index = gl_GlobalInvocationID.x / (side * side);
    if (view_index < push.view_count) {
        uint within = gl_GlobalInvocationID.x - view_index * side * side;
        uvec2 corner = uvec2(within % side, within / side) << LEVEL_BITS;
        uvec2 size = min(uvec2(4u), uvec2(finer_side) - corner);
        uvec4 found = uvec4(0u);
        for (uint place = 0u; place < size.x * size.y; ++place) {
            uvec2 block = corner + uvec2(place % size.x, place / size.x);
            found |= blocks[push.first_finer + (view_index * finer_side + block.y) * finer_side + block.x];
        }
        blocks[push.first + gl_GlobalInvocationID.x] = found;
    }
}
