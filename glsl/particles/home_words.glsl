// What stands for a facet: the number of a particle, or none.
#ifndef PARTICLES_HOME_WORDS
#define PARTICLES_HOME_WORDS

const uint LOST_FACET = 0xFFFFFFFFu;  // there is no particle near

#endif
