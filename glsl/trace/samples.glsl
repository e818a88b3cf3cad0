// How many samples something takes.
#ifndef TRACE_SAMPLES
#define TRACE_SAMPLES

// `weight`: what it counts in the picture. What changes it little takes few.
uint samples_for(uint most, float weight) {
    return clamp(uint(ceil(float(most) * min(4.0 * weight, 1.0))), 1u, most);
}

#endif
