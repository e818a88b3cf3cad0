// What stands for a point of the measurement of particles: a particle, or none.
#ifndef PARTICLES_HOME_WORDS
#define PARTICLES_HOME_WORDS

const uint NO_POINT = 0xFFFFFFFEu;    // alpha leaves nothing there
const uint LOST_POINT = 0xFFFFFFFFu;  // there is no particle near

#endif
