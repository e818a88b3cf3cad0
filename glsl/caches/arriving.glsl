// Virtual area lights, and what they send to a cache as points.
#ifndef CACHES_ARRIVING
#define CACHES_ARRIVING

#include "groups/area_lights.glsl"
#include "caches/light_groups.glsl"
#include "lib/vpl.glsl"

Vpl load_area_light(int index) {
    return unpack_vpl(texelFetch(area_lights, 2 * index), texelFetch(area_lights, 2 * index + 1));
}

// Φ/π · (n·−ω)⁺ / (d² + a), and the unit vector ω to the light.
vec3 point_light_from(Vpl light, vec3 position_rs, out vec3 direction) {
    vec3 difference = light.position_rs - position_rs;
    float squared = dot(difference, difference) + 1e-20;
    direction = difference * inversesqrt(squared);
    return light.strength * (max(-dot(light.normal, direction), 0.0) / (squared + light.area_over_pi));
}

#endif
