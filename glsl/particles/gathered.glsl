// What one particle receives of what its links end on, W/m². The including file binds links and radiance.
#ifndef PARTICLES_GATHERED
#define PARTICLES_GATHERED

#include "lib/vectors.glsl"
#include "particles/link.glsl"

// `own`: the particle, counted from the first one of the buffer of links.
vec3 gathered(uint own, uint link_count) {
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < link_count; ++i) {
        uint end = texelFetch(links, int(own * link_count + i)).x;
        if (ends_on_particle(end)) {
            sum += texelFetch(radiance, int(particle_of_link(end))).rgb;
        }
    }
    return sum * (PI / float(link_count));
}

#endif
