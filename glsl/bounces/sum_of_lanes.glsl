// The sum of what the 64 invocations of a group found, in a fixed order. All of them must come here.
#ifndef BOUNCES_SUM_OF_LANES
#define BOUNCES_SUM_OF_LANES

shared vec3 found_by_lane[64];

// Of use to invocation 0 alone.
vec3 sum_of_lanes(vec3 found) {
    found_by_lane[gl_LocalInvocationIndex] = found;
    barrier();
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (int lane = 0; lane < 64 && gl_LocalInvocationIndex == 0u; ++lane) {
        sum += found_by_lane[lane];
    }
    return sum;
}

#endif
