// Lists of neighbours: of a fixed room each.
#ifndef PARTICLES_LISTS
#define PARTICLES_LISTS

// Evenly spread, π·3² = 28 particles lie within reach.
const uint LIST_CAPACITY = 48u;
// The radius of the kernel that irradiance is read with, in spacings.
const float KERNEL_SPACINGS = 2.0;

#endif
