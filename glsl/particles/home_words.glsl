// What stands for a facet: the number of a particle, or none.
#ifndef PARTICLES_HOME_WORDS
#define PARTICLES_HOME_WORDS

const uint LOST_FACET = 0xFFFFFFFFu;  // there is no particle near
// Set where something stands on the facet: of what ends there the particle is searched.
const uint PARTED_FACET = 0x80000000u;

uint home_of_word(uint word) {
    return word == LOST_FACET ? word : word & ~PARTED_FACET;
}

#endif
