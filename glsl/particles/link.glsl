// Where links end: the number of a particle, or none.
#ifndef PARTICLES_LINK
#define PARTICLES_LINK

#include "lib/vectors.glsl"

const uint ESCAPED_LINK = 0xFFFFFFFFu;  // in the sky
const uint DARK_LINK = 0xFFFFFFFEu;     // where nothing is scattered diffusely

// Set where the link also brings light (arrivals.glsl).
const uint BRINGS_LIGHT = 0x80000000u;

bool ends_on_particle(uint link) {
    return link < DARK_LINK;
}

uint particle_of_link(uint link) {
    return link & ~BRINGS_LIGHT;
}

uint bringing_light(uint link, bool brings) {
    return brings && ends_on_particle(link) ? link | BRINGS_LIGHT : link;
}

// Around z with density cosθ/π, by the concentric map (Shirley & Chiu 1997): squares of strata stay compact.
vec3 cosine_direction(vec2 square) {
    vec2 centred = 2.0 * square - 1.0;
    bool wide = abs(centred.x) > abs(centred.y);
    float radius = wide ? centred.x : centred.y;
    float ratio = radius == 0.0 ? 0.0 : (wide ? centred.y : centred.x) / radius;
    float azimuth = wide ? 0.25 * PI * ratio : 0.5 * PI - 0.25 * PI * ratio;
    return vec3(radius * cos(azimuth), radius * sin(azimuth), sqrt(max(1.0 - radius * radius, 1e-7)));
}

#endif
