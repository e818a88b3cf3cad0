#version 460
#include "lib/prelude.glsl"

// One group turns the tiles' fluxes into their cumulative distribution: flux_prefix[t] = Σ_{s<t} tile_fluxes[s], t = 0 … tile_count, the
// total at the end. Each invocation sums a run of consecutive tiles, the group scans the 256 sums (Hillis & Steele 1986),
// each invocation walks its run again. Fixed order: the same bits every time.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) readonly buffer TileFluxes { vec4 tile_fluxes[]; };
layout(set = 0, binding = 1) writeonly buffer FluxPrefix { vec4 flux_prefix[]; };

layout(push_constant, scalar) uniform Push { uint tile_count; } push;

shared vec4 sums[256];

void main() {
    uint self = gl_LocalInvocationIndex;
    uint run = (push.tile_count + 255u) / 256u;
    uint first = min(self * run, push.tile_count);
    uint end = min(first + run, push.tile_count);

    vec4 sum = vec4(0.0);
    for (uint tile = first; tile < end; ++tile) {
        sum += tile_fluxes[tile];
    }
    sums[self] = sum;
    barrier();
    [[dont_unroll]] for (uint stride = 1u; stride < 256u; stride *= 2u) {
        vec4 lower = self >= stride ? sums[self - stride] : vec4(0.0);
        barrier();
        sums[self] += lower;
        barrier();
    }

    vec4 before = self > 0u ? sums[self - 1u] : vec4(0.0);
    for (uint tile = first; tile < end; ++tile) {
        flux_prefix[tile] = before;
        before += tile_fluxes[tile];
    }
    if (self == 255u) {
        flux_prefix[push.tile_count] = sums[255];
    }
}
