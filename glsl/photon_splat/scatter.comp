#version 460
#include "lib/prelude.glsl"
#include "photons/records.glsl"

// Copies one photon's disc to its place among those of its cell.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) uniform usamplerBuffer discs;
layout(set = 0, binding = 2) uniform usamplerBuffer places;
layout(set = 0, binding = 3) uniform usamplerBuffer cell_starts;
layout(set = 0, binding = 4) writeonly buffer SortedBlock { uvec4 sorted_discs[]; };

layout(push_constant, scalar) uniform Push {
    uint stage;
    uint reserved;
} push;

const uint NO_CELL = 0xFFFFFFFFu;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(counts, int(STAGE_WORDS * push.stage + COUNT_WORD)).x) {
        return;
    }
    uvec2 place = texelFetch(places, int(index)).xy;
    if (place.x == NO_CELL) {
        return;
    }
    uint target = 2u * (texelFetch(cell_starts, int(place.x)).x + place.y);
    sorted_discs[target] = texelFetch(discs, 2 * int(index));
    sorted_discs[target + 1u] = texelFetch(discs, 2 * int(index) + 1);
}
