// Where the links of a particle go: one of each stratum of the hemisphere, n a side.
#ifndef PARTICLES_LINK_DIRECTION
#define PARTICLES_LINK_DIRECTION

#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "particles/link.glsl"

// Its place in the square of all directions.
vec2 link_square(uint particle, uint link, uint side) {
    uint random = seed_of(particle, link);
    vec2 jitter = vec2(random & 0xFFFFu, random >> 16) / 65536.0;
    return (vec2(link % side, link / side) + jitter) / float(side);
}

vec3 link_direction(uint particle, uint link, uint side, vec3 normal) {
    return to_world(frame_around(normal), cosine_direction(link_square(particle, link, side)));
}

const uint NO_SCATTER_LINK = 0xFFFFFFFFu;

// Which of the fewer links for scattering a link is: one drawn of each square of strata.
uint scatter_link_of(uint particle, uint link, uint side, uint scatter_side) {
    uvec2 stratum = uvec2(link % side, link / side);
    uint block = side / scatter_side;
    uvec2 scatter = stratum / block;
    uvec2 within = stratum - scatter * block;
    uint number = scatter.y * scatter_side + scatter.x;
    uint chosen = seed_of(seed_of(particle, 0x5CA77E12u), number) % (block * block);
    return max(scatter.x, scatter.y) < scatter_side && within.y * block + within.x == chosen ? number : NO_SCATTER_LINK;
}

#endif
