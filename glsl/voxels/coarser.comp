#version 460
#include "lib/prelude.glsl"

// A voxel of the next coarser level, in whole numbers. w: the mean of the eight that it is made of (Reich 2015, 4.3.4). x, y, z: its opacity as it is seen along each axis, the mean
// over the four pairs that lie behind each other of the greater one. So a wall stays closed along its normal, whose mean fades by half with every level, and is as thin as it is
// along itself. Crassin et al. 2011 take 1 − (1 − a)(1 − b), as if what lies behind each other had nothing to do with each other: a wall seen edge-on then closes too.

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

layout(set = 0, binding = 0) uniform sampler3D finer;
layout(set = 0, binding = 1, rgba8) writeonly uniform image3D coarser;

// The mean over four pairs, rounded.
int behind_each_other(ivec4 front, ivec4 back) {
    ivec4 greater = max(front, back);
    return (greater.x + greater.y + greater.z + greater.w + 2) >> 2;
}

void main() {
    ivec3 place = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(place, imageSize(coarser)))) {
        return;
    }
    ivec4 part[8];
    ivec4 sum = ivec4(0);
    for (int index = 0; index < 8; ++index) {
        ivec3 at = 2 * place + ivec3(index & 1, index >> 1 & 1, index >> 2);
        part[index] = ivec4(round(255.0 * texelFetch(finer, at, 0)));
        sum += part[index];
    }
    ivec4 opacity;
    opacity.x = behind_each_other(
        ivec4(part[0].x, part[2].x, part[4].x, part[6].x), ivec4(part[1].x, part[3].x, part[5].x, part[7].x));
    opacity.y = behind_each_other(
        ivec4(part[0].y, part[1].y, part[4].y, part[5].y), ivec4(part[2].y, part[3].y, part[6].y, part[7].y));
    opacity.z = behind_each_other(
        ivec4(part[0].z, part[1].z, part[2].z, part[3].z), ivec4(part[4].z, part[5].z, part[6].z, part[7].z));
    opacity.w = (sum.w + 4) >> 3;
    imageStore(coarser, place, vec4(opacity) / 255.0);
}
