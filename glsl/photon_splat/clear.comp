#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "photon_splat/listed_tile.glsl"

// Sets the sums of the samples of a tile that photons reach to zero, an invocation every 64th word.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer SumBlock { uint sums[]; };

layout(push_constant, scalar) uniform Push {
    uint list;
    ivec2 range;  // of tiles
} push;

void main() {
    int tile = tile_in_range(listed_tile(splat_state, splat_tiles, push.list), push.range);
    if (tile != NO_TILE) {
        int first = 8 * TILE_SAMPLES * (tile - push.range.x);
        for (int word = int(gl_LocalInvocationIndex); word < 8 * TILE_SAMPLES; word += 64) {
            sums[first + word] = 0u;
        }
    }
}
