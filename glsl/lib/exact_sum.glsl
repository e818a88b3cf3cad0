// Sums of what is in no order: whole steps in 64 bits, the same whatever the order.
#ifndef LIB_EXACT_SUM
#define LIB_EXACT_SUM

struct Sum {
    uvec3 low;
    uvec3 high;
    uint count;
};

const Sum NO_SUM = Sum(uvec3(0u), uvec3(0u), 0u);

// Not negative.
void add(inout Sum sum, vec3 steps) {
    steps = min(steps, vec3(1e18));
    uvec3 high = uvec3(steps * (1.0 / 4294967296.0));
    uvec3 low = uvec3(steps - vec3(high) * 4294967296.0);
    uvec3 carry;
    sum.low = uaddCarry(sum.low, low, carry);
    sum.high += high + carry;
    ++sum.count;
}

vec3 steps_of(Sum sum) {
    return vec3(sum.high) * 4294967296.0 + vec3(sum.low);
}

#endif
