#version 460
#include "lib/prelude.glsl"
#include "voxels/blocks.glsl"
#include "voxels/grid.glsl"

// Distance 0 of blocks in which any voxel has an opacity, and the longest of all others.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler3D opacity;
layout(set = 0, binding = 1) writeonly buffer DistanceBlock { uint distances[]; };

void main() {
    ivec3 dims = textureSize(opacity, 0);
    ivec3 blocks = blocks_of(dims);
    int number = int(gl_GlobalInvocationID.x);
    if (number >= blocks.x * blocks.y * blocks.z) {
        return;
    }
    ivec3 first = BLOCK * ivec3(number % blocks.x, number / blocks.x % blocks.y, number / (blocks.x * blocks.y));
    float most = 0.0;
    [[dont_unroll]] for (int index = 0; index < BLOCK * BLOCK * BLOCK; ++index) {
        ivec3 voxel = min(first + ivec3(index % BLOCK, index / BLOCK % BLOCK, index / (BLOCK * BLOCK)), dims - 1);
        most = max(most, texelFetch(opacity, voxel, 0).w);
    }
    distances[number] = most > 0.0 ? 0u : uint(FAR_BLOCK);
}
