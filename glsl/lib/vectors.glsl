// Small vector functions that GLSL lacks.
#ifndef LIB_VECTORS
#define LIB_VECTORS

#include "lib/finite.glsl"

const float PI = 3.14159265358979;
const float INVERSE_PI = 0.318309886183791;

float max3(vec3 v) {
    return max(v.x, max(v.y, v.z));
}

// The unit vector along v, or `fallback` for the null vector and for what is no vector. Division by the largest component first keeps the squares
// of tiny and of huge vectors (normals of micrometre triangles) inside the range of a float.
vec3 normalize_or(vec3 v, vec3 fallback) {
    float largest = max3(abs(v));
    return is_finite(v) && largest > 0.0 ? normalize(v / largest) : fallback;
}

#endif
