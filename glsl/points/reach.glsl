// How many pixels to each side the filter spreads light over.
#ifndef POINTS_REACH
#define POINTS_REACH

// 1: the filter's width is metres on the surface; 0: pixels.
layout(constant_id = 0) const uint WORLD = 0u;

const int SCREEN_REACH = 3;
// Near the eye radii end here: the filter's cost is its square.
const int MOST_REACH = 15;
// Pixels: less would fall between their middles.
const float LEAST_RADIUS = 1.0;

// `radius`: the larger one; `extent`: of a pixel there; metres.
int reach_of(float radius, float extent) {
    return WORLD == 0u ? SCREEN_REACH : min(int(ceil(radius / extent)), MOST_REACH);
}

#endif
