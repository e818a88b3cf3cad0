// What the surfaces that ask for a cache have in front of them: of those whose normals have the same largest component, eight words, greatest numbers, 0 where nothing asked. With
// b from 0 to 5 for +x, −x, +y, …, and i = 6k + b,
//   [8i] to [8i + 2]      minus the least components of their normals, in steps
//   [8i + 3]              how far the cache lies before any of them at most, in cells, HORIZON_LIFT added so that it is positive, as a float's bits
//   [8i + 4] to [8i + 6]  the greatest components
#ifndef CACHES_HORIZONS
#define CACHES_HORIZONS

const float HORIZON_LIFT = 8.0;
const float HORIZON_STEPS = 32767.5;
// Lights that are lower over a surface than this many cells lie on it.
const float HORIZON_TOLERANCE = 0.02;

// Kinds of surfaces by the largest components of their normals.
const uint FACINGS = 6u;

struct Horizon {
    vec3 low;
    vec3 high;
    float height;  // m
};

uint facing_of(vec3 normal) {
    vec3 size = abs(normal);
    uint axis = size.x >= max(size.y, size.z) ? 0u : size.y >= size.z ? 1u : 2u;
    return 2u * axis + (normal[axis] < 0.0 ? 1u : 0u);
}

uint component_steps(float component) {
    return uint((clamp(component, -1.0, 1.0) + 1.0) * HORIZON_STEPS + 0.5) + 1u;
}

// Nothing asked: nothing is above it.
bool is_nowhere(uvec4 first) {
    return first.w == 0u;
}

Horizon unpack_horizon(uvec4 first, uvec4 second, float cell) {
    vec3 low = 1.0 - (vec3(first.xyz) - 1.0) / HORIZON_STEPS;
    vec3 high = (vec3(second.xyz) - 1.0) / HORIZON_STEPS - 1.0;
    return Horizon(low, high, (uintBitsToFloat(first.w) - HORIZON_LIFT - HORIZON_TOLERANCE) * cell);
}

// Whether a point lies in front of any of the surfaces; `way`: to it from the cache. Where x + h is a point of a surface with normal n, and the cache a height before it,
// the point is n·way + height before the surface: at most what the box around all normals and the greatest height have.
bool is_above(Horizon horizon, vec3 way) {
    vec3 most = max(horizon.low * way, horizon.high * way);
    return most.x + most.y + most.z + horizon.height > 0.0;
}

#endif
