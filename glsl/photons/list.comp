#version 460
#include "lib/prelude.glsl"
#include "photons/squares.glsl"

// One group lists the marked blocks of one square by their numbers: column and row in 16 bits each.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer MarkBlock { uint marks[]; };
layout(set = 0, binding = 1) readonly buffer FirstBlock { uint square_firsts[]; };
layout(set = 0, binding = 2) writeonly buffer BlockList { uint blocks[]; };

layout(push_constant, scalar) uniform Push {
    uint capacity;
} push;

void main() {
    uint square = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint place = square_firsts[square];
    if (square_firsts[square + 1u] == place) {
        return;
    }
    // Sixteen bits an invocation.
    uint word = gl_LocalInvocationIndex >> 1;
    uint first = 16u * (gl_LocalInvocationIndex & 1u);
    [[dont_unroll]] for (uint before = 0u; before < word; ++before) {
        place += uint(bitCount(marks[SQUARE_WORDS * square + before]));
    }
    uint bits = marks[SQUARE_WORDS * square + word];
    place += uint(bitCount(bits & ((1u << first) - 1u)));
    bits = bits >> first & 0xFFFFu;
    while (bits != 0u) {
        uint bit = first + uint(findLSB(bits));
        bits &= bits - 1u;
        if (place < push.capacity) {
            uvec2 block = 32u * gl_WorkGroupID.xy + place_in_square(word >> 1, (word & 1u) * 32u + bit);
            blocks[place] = block.y << 16 | block.x;
        }
        ++place;
    }
}
