#version 460
#include "lib/prelude.glsl"
#include "groups/light_views.glsl"
#include "lib/lights.glsl"
#include "vpl/blocks.glsl"

// One group makes one view's summed-area table (Crow 1984): sums(x, y) = Σ of all blocks from the view's corner to (x, y), both included.
// First every row is summed from left to right, then every column downwards, in a fixed order: the same bits every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D blocks;
layout(set = 0, binding = 1, rgba32f) coherent uniform image2D sums;
layout(set = 0, binding = 2) writeonly buffer ViewFluxes { vec4 view_fluxes[]; };

void main() {
    LightView view = load_view(views, gl_WorkGroupID.x);
    ivec2 origin = view.rect_origin / BLOCK_SIDE;
    ivec2 size = view.rect_size / BLOCK_SIDE;
    int self = int(gl_LocalInvocationIndex);
    for (int y = self; y < size.y; y += 64) {
        vec4 sum = vec4(0.0);
        for (int x = 0; x < size.x; ++x) {
            sum += texelFetch(blocks, origin + ivec2(x, y), 0);
            imageStore(sums, origin + ivec2(x, y), sum);
        }
    }
    memoryBarrierImage();
    barrier();
    for (int x = self; x < size.x; x += 64) {
        vec4 sum = vec4(0.0);
        for (int y = 0; y < size.y; ++y) {
            sum += imageLoad(sums, origin + ivec2(x, y));
            imageStore(sums, origin + ivec2(x, y), sum);
        }
        if (x == size.x - 1) {
            view_fluxes[gl_WorkGroupID.x] = sum;
        }
    }
}
