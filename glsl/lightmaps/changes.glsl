// What counts as a change of what comes along a texel's links.
#ifndef LIGHTMAPS_CHANGES
#define LIGHTMAPS_CHANGES

#include "lib/vectors.glsl"

// Share of it.
const float LEAST_CHANGE = 0.01;

float change_of(vec3 now, vec3 then) {
    return max3(abs(now - then));
}

bool is_change(vec3 now, vec3 then) {
    return change_of(now, then) > LEAST_CHANGE * max(max3(now), max3(then));
}

#endif
