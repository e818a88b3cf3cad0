#version 460
#include "lib/prelude.glsl"

// One texel becomes offset + x + y·width.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, r32f) writeonly uniform image2D image;

layout(push_constant, scalar) uniform Push { float offset; } push;

void main() {
    ivec2 size = imageSize(image);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, size))) {
        imageStore(image, texel, vec4(push.offset + float(texel.x + texel.y * size.x)));
    }
}
