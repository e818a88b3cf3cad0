#version 460
#include "lib/prelude.glsl"
#include "photon_splat/listed_tile.glsl"

// Sets the sums of the samples of a tile that photons reach to zero, an invocation every 64th word.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer state;
layout(set = 0, binding = 1) uniform usamplerBuffer tiles;
layout(set = 0, binding = 2) writeonly buffer SumBlock { uint sums[]; };

layout(push_constant, scalar) uniform Push { uint list; } push;

void main() {
    int tile = listed_tile(state, tiles, push.list);
    if (tile != NO_TILE) {
        int first = 8 * TILE_SAMPLES * tile;
        for (int word = int(gl_LocalInvocationIndex); word < 8 * TILE_SAMPLES; word += 64) {
            sums[first + word] = 0u;
        }
    }
}
