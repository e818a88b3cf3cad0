#version 460
#include "lib/prelude.glsl"
#include "voxels/lists.glsl"

// Empty lists of triangles and tiles.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) writeonly buffer CountBlock { uint counts[]; };

void main() {
    for (uint word = 0u; word < COUNT_WORDS; ++word) {
        counts[word] = 0u;
    }
    counts[1] = 1u;
    counts[GROUPS_OF_TILES + 1u] = 1u;
    counts[GROUPS_OF_TILES + 2u] = 1u;
    counts[GROUPS_OF_SOLID_TILES + 1u] = 1u;
    counts[GROUPS_OF_SOLID_TILES + 2u] = 1u;
}
