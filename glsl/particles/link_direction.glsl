// Where the links of a particle go: one of each stratum of the hemisphere, n a side. Every quarter of them, one after the other, has one stratum of each square of
// 2x2, so that neighbours may gather by a quarter each (gather.comp).
#ifndef PARTICLES_LINK_DIRECTION
#define PARTICLES_LINK_DIRECTION

#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "particles/link.glsl"

uvec2 stratum_of_link(uint link, uint side) {
    uint half_side = side / 2u;
    uint quarter = link / (half_side * half_side);
    uint within = link % (half_side * half_side);
    return 2u * uvec2(within % half_side, within / half_side) + uvec2(quarter & 1u, quarter >> 1);
}

// Its place in the square of all directions.
vec2 link_square(uint particle, uint link, uint side) {
    uint random = seed_of(particle, link);
    vec2 jitter = vec2(random & 0xFFFFu, random >> 16) / 65536.0;
    return (vec2(stratum_of_link(link, side)) + jitter) / float(side);
}

vec3 link_direction(uint particle, uint link, uint side, vec3 normal) {
    return to_world(frame_around(normal), cosine_direction(link_square(particle, link, side)));
}

const uint NO_SCATTER_LINK = 0xFFFFFFFFu;

// Which of the fewer links for scattering a link is: one drawn of each square of strata.
uint scatter_link_of(uint particle, uint link, uint side, uint scatter_side) {
    uvec2 stratum = stratum_of_link(link, side);
    uint block = side / scatter_side;
    uvec2 scatter = stratum / block;
    uvec2 within = stratum - scatter * block;
    uint number = scatter.y * scatter_side + scatter.x;
    uint chosen = seed_of(seed_of(particle, 0x5CA77E12u), number) % (block * block);
    return max(scatter.x, scatter.y) < scatter_side && within.y * block + within.x == chosen ? number : NO_SCATTER_LINK;
}

#endif
