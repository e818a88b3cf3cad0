// Specular events as bounces: where the number of bounces is limited, what lights send to particles by way of mirrors and glass is summed by how many of these it met.
#ifndef PARTICLES_EVENTS
#define PARTICLES_EVENTS

// Sums of light that met 0, 1, … specular events; what met more is left out. 0: nothing is limited, one sum has all of it.
layout(constant_id = 4) const uint EVENT_LEVELS = 0u;

bool is_counted(uint events) {
    return EVENT_LEVELS == 0u || events < EVENT_LEVELS;
}

#endif
