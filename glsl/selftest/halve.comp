#version 460
#include "lib/prelude.glsl"

// One texel of a coarser mip level becomes the sum of the four texels below it; beyond the border there is nothing.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D finer;
layout(set = 0, binding = 1, r32f) writeonly uniform image2D coarser;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(coarser)))) {
        return;
    }
    ivec2 last = textureSize(finer, 0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 source = 2 * texel + ivec2(i & 1, i >> 1);
        sum += all(lessThan(source, last)) ? texelFetch(finer, source, 0).x : 0.0;
    }
    imageStore(coarser, texel, vec4(sum));
}
