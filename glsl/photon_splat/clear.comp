#version 460
#include "lib/prelude.glsl"
#include "photon_splat/listed_tile.glsl"

// Sets the sums of one sample of a tile that photons reach to zero.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer state;
layout(set = 0, binding = 1) uniform usamplerBuffer tiles;
layout(set = 0, binding = 2) writeonly buffer SumBlock { uint sums[]; };

layout(push_constant, scalar) uniform Push { uint reserved; } push;

void main() {
    int tile = listed_tile(state, tiles);
    if (tile != NO_TILE) {
        uint first = 8u * (64u * uint(tile) + gl_LocalInvocationIndex);
        for (uint word = first; word < first + 8u; ++word) {
            sums[word] = 0u;
        }
    }
}
