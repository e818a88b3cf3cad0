#version 460
#include "lib/prelude.glsl"
#include "voxels/grid.glsl"

// The finest level of the voxels' opacity: of four neighbours along x what their bits say, or, where opacity adapts over frames, their bytes.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint ADAPTED = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer bits;
layout(set = 0, binding = 1) uniform usamplerBuffer opacities;
layout(set = 0, binding = 2, rgba8) writeonly uniform image3D finest;

layout(push_constant, scalar) uniform Push { VoxelGrid grid; } push;

void main() {
    ivec3 place = ivec3(gl_GlobalInvocationID) * ivec3(4, 1, 1);
    if (any(greaterThanEqual(place, push.grid.dims))) {
        return;
    }
    uint first = voxel_number(place, push.grid.dims);
    vec4 opacity;
    if (ADAPTED != 0u) {
        opacity = unpackUnorm4x8(texelFetch(opacities, int(first >> 2)).x);
    } else {
        uint occupied = texelFetch(bits, int(first >> 5)).x >> (first & 31u);
        opacity = vec4(notEqual(uvec4(occupied) & uvec4(1u, 2u, 4u, 8u), uvec4(0u)));
    }
    for (int voxel = 0; voxel < 4; ++voxel) {
        imageStore(finest, place + ivec3(voxel, 0, 0), vec4(opacity[voxel]));
    }
}
