#version 460
#include "lib/prelude.glsl"
#include "rsm/texels.glsl"

// One group sums one tile of 16x16 light-view texels: Σ Φ [W] in rgb and Σ A [m²] in a, the first step towards the
// cumulative distribution of reflected flux. The sum is a binary tree of fixed shape: the same bits every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 1) writeonly buffer TileFluxes { vec4 tile_fluxes[]; };
layout(set = 0, binding = 2) buffer DroppedBlock { uint dropped_texels[]; };

layout(push_constant, scalar) uniform Push { uint tile_count; } push;

shared vec4 partial[64];

void main() {
    uint self = gl_LocalInvocationIndex;
    for (uint tile = gl_WorkGroupID.x; tile < push.tile_count; tile += gl_NumWorkGroups.x) {
        LightView view = load_view(views, tiles[tile].view);
        vec4 sum = vec4(0.0);
        [[dont_unroll]] for (uint index = self; index < TILE_TEXELS; index += 64u) {
            bool dropped = false;
            sum += flux_and_area(view, tiles[tile].origin + ivec2(index & 15u, index >> 4), dropped);
            if (dropped) {
                atomicAdd(dropped_texels[0], 1u);
            }
        }
        partial[self] = sum;
        barrier();
        [[dont_unroll]] for (uint stride = 32u; stride > 0u; stride /= 2u) {
            if (self < stride) {
                partial[self] += partial[self + stride];
            }
            barrier();
        }
        if (self == 0u) {
            tile_fluxes[tile] = partial[0];
        }
        barrier();
    }
}
