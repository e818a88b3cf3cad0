#version 460
#include "lib/prelude.glsl"
#include "photons/choice.glsl"
#include "photons/records.glsl"

// Readies one turn of photons, those of number `first` and every `stride`-th from there on: empties the counts of all stages, and counts the turn's as arrived at the
// surfaces that light meets first.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) uniform usamplerBuffer choice;
layout(set = 0, binding = 1) writeonly buffer CountBlock { uint counts[]; };
layout(set = 0, binding = 2) writeonly buffer ArrivalCountBlock { uint arrival_counts[]; };

layout(push_constant, scalar) uniform Push {
    uint first;
    uint stride;
    uint stage_count;  // of `counts`
} push;

void main() {
    uint photons = texelFetch(choice, int(CHOICE_PHOTONS)).x;
    photons = photons > push.first ? (photons - push.first - 1u) / push.stride + 1u : 0u;
    [[dont_unroll]] for (uint stage = 0u; stage < push.stage_count; ++stage) {
        const uint[STAGE_WORDS] empty = uint[STAGE_WORDS](0u, 1u, 1u, 0u, 6u, 0u, 0u, 0u);
        [[dont_unroll]] for (uint word = 0u; word < STAGE_WORDS; ++word) {
            counts[stage * STAGE_WORDS + word] = empty[word];
            bool first = stage == 0u && word == 0u;
            bool counted = stage == 0u && word == COUNT_WORD;
            arrival_counts[stage * STAGE_WORDS + word] = first ? (photons + 63u) / 64u : counted ? photons : empty[word];
        }
    }
}
