#version 460
#include "lib/prelude.glsl"

// Each texel of a coarser level of a volume is the sum of eight of the finer one.

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

layout(set = 0, binding = 0) uniform sampler3D finer;
layout(set = 0, binding = 1, r32f) writeonly uniform image3D coarser;

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel, imageSize(coarser)))) {
        return;
    }
    float sum = 0.0;
    for (int part = 0; part < 8; ++part) {
        ivec3 place = 2 * texel + ivec3(part & 1, part >> 1 & 1, part >> 2);
        sum += all(lessThan(place, textureSize(finer, 0))) ? texelFetch(finer, place, 0).x : 0.0;
    }
    imageStore(coarser, texel, vec4(sum));
}
