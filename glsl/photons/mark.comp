#version 460
#include "lib/prelude.glsl"
#include "photons/choice.glsl"
#include "photons/squares.glsl"

// One group marks the blocks of one square of the chosen level that are not empty, and counts them. The levels five and three above hold
// the square and its parts as one block each.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D mask;
layout(set = 0, binding = 1) uniform usamplerBuffer levels;
layout(set = 0, binding = 2) uniform usamplerBuffer pyramid;
layout(set = 0, binding = 3) uniform usamplerBuffer choice;
layout(set = 0, binding = 4) writeonly buffer MarkBlock { uint marks[]; };
layout(set = 0, binding = 5) writeonly buffer CountBlock { uint square_counts[]; };

layout(push_constant, scalar) uniform Push {
    uint level_count;
} push;

#include "photons/pyramid.glsl"

bool is_taken(uint number, ivec2 block) {
    Level level = load_level(number);
    if (!holds(level, block)) {
        return false;
    }
    return number == 0u ? sound_flux(texelFetch(mask, block, 0).x) > 0.0 : uintBitsToFloat(texelFetch(pyramid, int(place_of_block(level, block))).x) > 0.0;
}

// Whether the square of 2^above blocks to a side may hold some.
bool may_hold(uint level, uint above, ivec2 square) {
    return level + above >= push.level_count || is_taken(level + above, square);
}

shared uint words[SQUARE_WORDS];

void main() {
    uint self = gl_LocalInvocationIndex;
    uint level = texelFetch(choice, int(CHOICE_LEVEL)).x;
    uint square = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (!may_hold(level, 5u, ivec2(gl_WorkGroupID.xy))) {
        if (self == 0u) {
            square_counts[square] = 0u;
        }
        return;
    }
    if (self < SQUARE_WORDS) {
        words[self] = 0u;
    }
    barrier();
    [[dont_unroll]] for (uint part = 0u; part < 16u; ++part) {
        uvec2 block = 32u * gl_WorkGroupID.xy + place_in_square(part, self);
        if (may_hold(level, 3u, ivec2(block >> 3)) && is_taken(level, ivec2(block))) {
            atomicOr(words[2u * part + (self >> 5)], 1u << (self & 31u));
        }
    }
    barrier();
    if (self < SQUARE_WORDS) {
        marks[SQUARE_WORDS * square + self] = words[self];
    }
    if (self == 0u) {
        uint count = 0u;
        [[dont_unroll]] for (uint word = 0u; word < SQUARE_WORDS; ++word) {
            count += uint(bitCount(words[word]));
        }
        square_counts[square] = count;
    }
}
