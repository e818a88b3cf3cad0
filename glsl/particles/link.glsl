// Where links end: the number of a particle, or none.
#ifndef PARTICLES_LINK
#define PARTICLES_LINK

#include "lib/vectors.glsl"

const uint ESCAPED_LINK = 0xFFFFFFFFu;  // in the sky
const uint DARK_LINK = 0xFFFFFFFEu;     // where nothing is scattered diffusely

// Set where the link also brings light (arrivals.glsl).
const uint BRINGS_LIGHT = 0x80000000u;

// Set of a link for gathering whose end is nearer than this, spacings of the closest particles.
const uint NEAR_LINK = 0x40000000u;
const float NEAR_SPACINGS = 2.0;

// Of a link for scattering the channels that were lost on its way, and how many specular events it met: none, or up to 8 off mirrors, coats and through glass.
const uint WITHOUT_RED = 0x20000000u;
const uint WITHOUT_GREEN = 0x10000000u;
const uint WITHOUT_BLUE = 0x08000000u;
const uint EVENTS_SHIFT = 23u;
const uint EVENTS_MASK = 15u;
const uint PARTICLE_BITS = 0x007FFFFFu;

bool ends_on_particle(uint link) {
    return link < DARK_LINK;
}

uint particle_of_link(uint link) {
    return link & PARTICLE_BITS;
}

uint events_of_link(uint link) {
    return link >> EVENTS_SHIFT & EVENTS_MASK;
}

// 1 for each channel of light that the link takes along, or 0.
uvec3 channels_of_link(uint link) {
    return uvec3(equal(uvec3(link) & uvec3(WITHOUT_RED, WITHOUT_GREEN, WITHOUT_BLUE), uvec3(0u)));
}

// A link off mirrors or through glass, `events` of them, which let `carried` of light pass: it stands for each channel with that probability.
uint link_behind(uint particle, uint events, vec3 carried, float random) {
    bvec3 lost = greaterThanEqual(vec3(random), carried);
    if (all(lost)) {
        return DARK_LINK;
    }
    uvec3 marks = uvec3(lost) * uvec3(WITHOUT_RED, WITHOUT_GREEN, WITHOUT_BLUE);
    return particle | events << EVENTS_SHIFT | marks.r | marks.g | marks.b;
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
