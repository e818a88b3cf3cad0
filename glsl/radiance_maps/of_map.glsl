// The map that a group of invocations works for.
#ifndef RADIANCE_MAPS_OF_MAP
#define RADIANCE_MAPS_OF_MAP

// Of the invocation's group, for dispatches by words 0 to 2 of the maps' head (radiance_maps/choose.comp).
uint map_of_group() {
    return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

// Texels hold whole numbers of 1/s, s the largest power of two for which all light that may come to the cache is below 2³¹ of them: no sum overflows, and its bits do
// not depend on the order.
float scale_of_bound(float bound) {
    int exponent = (floatBitsToInt(bound) >> 23) - 127;
    return bound > 0.0 ? uintBitsToFloat(uint(clamp(30 - exponent + 127, 1, 254)) << 23) : 0.0;
}

#endif
