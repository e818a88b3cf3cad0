// What is kept of all rounds of photons whose mean the AIM is, beside the paths of the last one, in words:
//
//   bits of the lights whose photons came to a side of a surface, by side | the box around all points of a light's paths, six words, by light |
//   the round that a group was last sent in, by group
//
// So it is known which surfaces hold light that is no longer right when something changes. A bit may stand for several lights.
#ifndef LIGHTMAPS_ROUNDS
#define LIGHTMAPS_ROUNDS

uint bit_of_light(uint light) {
    return 1u << (light & 31u);
}

// The highest corner, and the highest one of all that is mirrored at the origin. 0: of nothing.
uint box_of_light(uint sides, uint light) {
    return sides + 6u * light;
}

uint round_of_group(uint sides, uint lights, uint group) {
    return sides + 6u * lights + group;
}

// Floats in the order of unsigned numbers, above 0.
uint ordered(float value) {
    uint bits = floatBitsToUint(value);
    return bits >> 31 != 0u ? ~bits : bits | 0x80000000u;
}

float of_ordered(uint word) {
    return uintBitsToFloat(word >> 31 != 0u ? word & 0x7FFFFFFFu : ~word);
}

// Whether a box in six such words meets another one.
bool meets_words(usamplerBuffer words, uint first, vec3 low, vec3 high) {
    bool meets = texelFetch(words, int(first)).x != 0u;
    for (int axis = 0; axis < 3; ++axis) {
        float highest = of_ordered(texelFetch(words, int(first) + axis).x);
        float lowest = -of_ordered(texelFetch(words, int(first) + 3 + axis).x);
        meets = meets && low[axis] <= highest && high[axis] >= lowest;
    }
    return meets;
}

#endif
