// Lists of neighbours: of a fixed room each. Where more lie within reach than there is room for, the reach is shorter: of each list its length and the share of the
// reach that it has are in one word.
#ifndef PARTICLES_LISTS
#define PARTICLES_LISTS

// Evenly spread, π·3² = 28 particles lie within reach.
const uint LIST_CAPACITY = 48u;
// The radius of the kernel that irradiance is read with, in spacings of the particle whose list it is.
const float KERNEL_SPACINGS = 2.0;

const uint REACH_STEPS = 1024u;

uint list_word(uint length, uint reach_steps) {
    return length | reach_steps << 16;
}

uint length_of_list(uint word) {
    return word & 0xFFFFu;
}

float reach_of_list(uint word) {
    return float(word >> 16) / float(REACH_STEPS);
}

#endif
