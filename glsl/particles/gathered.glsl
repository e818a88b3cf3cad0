// What links that gather end on. The including file binds links and radiance.
#ifndef PARTICLES_GATHERED
#define PARTICLES_GATHERED

#include "particles/link.glsl"

// W/(m²·sr), of one link.
vec3 radiance_at_end(uint end) {
    return ends_on_particle(end) ? texelFetch(radiance, int(particle_of_link(end))).rgb : vec3(0.0);
}

#endif
