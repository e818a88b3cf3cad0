#version 460
#include "lib/prelude.glsl"

// The index of each texel, x fastest.

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

layout(set = 0, binding = 0, r32f) writeonly uniform image3D image;

void main() {
    ivec3 size = imageSize(image);
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(texel, size))) {
        imageStore(image, texel, vec4(float((texel.z * size.y + texel.y) * size.x + texel.x)));
    }
}
