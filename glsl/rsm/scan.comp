#version 460
#include "lib/prelude.glsl"

// One group turns the tiles' fluxes into their cumulative distribution: flux_prefix[t] = Σ_{s<t} tile_fluxes[s], t = 0 … tile_count, the
// total at the end.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) readonly buffer TileFluxes { vec4 tile_fluxes[]; };
layout(set = 0, binding = 1) writeonly buffer FluxPrefix { vec4 flux_prefix[]; };

layout(push_constant, scalar) uniform Push { uint tile_count; } push;

#define SCAN_TYPE vec4

vec4 scan_term(uint tile) {
    return tile_fluxes[tile];
}

void scan_store(uint tile, vec4 before) {
    flux_prefix[tile] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.tile_count);
}
