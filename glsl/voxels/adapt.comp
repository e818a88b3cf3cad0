#version 460
#include "lib/prelude.glsl"
#include "voxels/grid.glsl"

// The opacity of four voxels, 8 bits each, moves from what it was in the last frame towards what is there now (Reich 2015, 4.5.4): by 1 − exp(−rate·Δt) of the
// difference, and by one step at least, so that it arrives.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform usamplerBuffer bits;
layout(set = 0, binding = 1) uniform usamplerBuffer last;
layout(set = 0, binding = 2) writeonly buffer NextBlock { uint next[]; };

layout(push_constant, scalar) uniform Push {
    VoxelGrid grid;
    float share;
} push;

void main() {
    ivec3 place = ivec3(gl_GlobalInvocationID) * ivec3(4, 1, 1);
    if (any(greaterThanEqual(place, push.grid.dims))) {
        return;
    }
    uint first = voxel_number(place, push.grid.dims);
    uint word = first >> 2;
    uint occupied = texelFetch(bits, int(first >> 5)).x >> (first & 31u);
    uint before = texelFetch(last, int(word)).x;
    uint after = 0u;
    for (uint voxel = 0u; voxel < 4u; ++voxel) {
        int target = (occupied >> voxel & 1u) != 0u ? 255 : 0;
        int old = int(before >> (8u * voxel) & 255u);
        int way = target - old;
        int moved = min(abs(way), max(int(floor(push.share * float(abs(way)) + 0.5)), push.share > 0.0 ? 1 : 0));
        after |= uint(old + sign(way) * moved) << (8u * voxel);
    }
    next[word] = after;
}
