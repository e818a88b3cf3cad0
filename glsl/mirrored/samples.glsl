// How many samples something takes.
#ifndef MIRRORED_SAMPLES
#define MIRRORED_SAMPLES

// `weight`: what it counts in the picture. What changes it little takes few.
uint samples_for(uint most, float weight) {
    return clamp(uint(ceil(float(most) * min(4.0 * weight, 1.0))), 1u, most);
}

#endif
