#version 460
#include "lib/prelude.glsl"
#include "voxels/blocks.glsl"

// The distance of a block from the nearest one that holds anything, along one axis: min over k of max(|k|, d(block + k)). All three axes after each other give the greatest
// of the three differences, in blocks.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer before;
layout(set = 0, binding = 1) writeonly buffer DistanceBlock { uint distances[]; };

layout(push_constant, scalar) uniform Push {
    ivec3 blocks;
    int axis;
} push;

void main() {
    int number = int(gl_GlobalInvocationID.x);
    if (number >= push.blocks.x * push.blocks.y * push.blocks.z) {
        return;
    }
    ivec3 strides = ivec3(1, push.blocks.x, push.blocks.x * push.blocks.y);
    int stride = strides[push.axis];
    int place = number / stride % push.blocks[push.axis];
    int nearest = int(texelFetch(before, number).x);
    for (int step = 1; step < nearest; ++step) {
        if (place >= step) {
            nearest = min(nearest, max(step, int(texelFetch(before, number - step * stride).x)));
        }
        if (place + step < push.blocks[push.axis]) {
            nearest = min(nearest, max(step, int(texelFetch(before, number + step * stride).x)));
        }
    }
    distances[number] = uint(nearest);
}
