// Whether values are numbers, told by their exponent's bits: drivers may assume that there are no NaNs and fold comparisons and isnan() away.
#ifndef LIB_FINITE
#define LIB_FINITE

bool is_finite(float value) {
    return (floatBitsToUint(value) & 0x7F800000u) != 0x7F800000u;
}

bool is_finite(vec2 value) {
    return all(notEqual(floatBitsToUint(value) & 0x7F800000u, uvec2(0x7F800000u)));
}

bool is_finite(vec3 value) {
    return all(notEqual(floatBitsToUint(value) & 0x7F800000u, uvec3(0x7F800000u)));
}

bool is_finite(vec4 value) {
    return all(notEqual(floatBitsToUint(value) & 0x7F800000u, uvec4(0x7F800000u)));
}

#endif
