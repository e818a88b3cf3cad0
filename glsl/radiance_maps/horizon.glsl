// What the surfaces around a cache have in common. Where all that pixels show of them faces one way, light from behind their plane reaches none: it is not written, and none is
// looked for. Three words a cache, zero at first, each the greatest that a pixel asks for: the complement of a triangle's packed normal, the normal, and the cascade above how
// far below 8 cells the surface lies before the cache, in 2⁻²⁴ cells.
#ifndef RADIANCE_MAPS_HORIZON
#define RADIANCE_MAPS_HORIZON

#include "caches/cascades.glsl"
#include "lib/octahedral.glsl"

const float HORIZON_REACH = 8.0;
const float MAP_HORIZON_STEPS = 16777216.0;
const uint HORIZON_BITS = 28u;
// Light must come from so far before the plane, in cells.
const float HORIZON_MARGIN = 0.01;

uint horizon_word(int cascade, float cells_before) {
    float below = clamp(HORIZON_REACH - cells_before, 0.0, 2.0 * HORIZON_REACH - 1e-3);
    return uint(cascade) << HORIZON_BITS | uint(below * MAP_HORIZON_STEPS);
}

bool has_horizon(uvec3 words) {
    return words.y != 0u && ~words.x == words.y;
}

// A plane from the cache: what is before it has dot(normal, way) > height. Without one all is.
struct MapHorizon {
    vec3 normal;
    float height;
};

MapHorizon horizon_of(Cascades cascades, uvec3 words) {
    if (!has_horizon(words)) {
        return MapHorizon(vec3(0.0), -1.0);
    }
    float cell = cell_of_cascade(cascades, int(words.z >> HORIZON_BITS));
    float before = HORIZON_REACH - float(words.z & (1u << HORIZON_BITS) - 1u) / MAP_HORIZON_STEPS;
    return MapHorizon(unpack_direction(words.y), (before + HORIZON_MARGIN) * cell);
}

bool is_before(MapHorizon horizon, vec3 way) {
    return dot(horizon.normal, way) > horizon.height;
}

#endif
