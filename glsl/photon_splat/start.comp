#version 460
#include "lib/prelude.glsl"
#include "photons/records.glsl"
#include "photon_splat/state.glsl"

// One invocation says how much work the passes over cells and tiles have: none where no photon landed.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) writeonly buffer StateBlock { uint state[]; };

layout(push_constant, scalar) uniform Push {
    uint stage;
    uint row_count;
    uvec2 blocks;
} push;

void main() {
    bool any_photon = texelFetch(counts, int(STAGE_WORDS * push.stage + COUNT_WORD)).x > 0u;
    state[STATE_ROWS] = any_photon ? min(push.row_count, 65535u) : 0u;
    state[STATE_ROWS + 1u] = 1u;
    state[STATE_ROWS + 2u] = 1u;
    state[STATE_BLOCKS] = any_photon ? push.blocks.x : 0u;
    state[STATE_BLOCKS + 1u] = push.blocks.y;
    state[STATE_BLOCKS + 2u] = 1u;
    for (uint word = STATE_TILES; word <= STATE_DROPPED; ++word) {
        state[word] = 0u;
    }
    state[STATE_TILES + 2u] = 1u;
    state[STATE_CROWDED + 2u] = 1u;
}
