// What the links of each particle bring of the light that no particle sends, in whole steps, so that their order does not matter: three words of the share of
// the sky that they see, directly, in mirrors and through glass; where surfaces emit, two words a channel of these surfaces' light. Where specular events are counted
// (events.glsl) the first three have what the links see directly; behind the words of all particles lie those of the sky in one event, in two and so on.
#ifndef PARTICLES_ARRIVALS
#define PARTICLES_ARRIVALS

// 1: some surface emits.
layout(constant_id = 1) const uint HAS_EMITTERS = 0u;

// Of one link's share of the sky.
const uint SKY_STEPS = 1024u;
// Of the greatest radiance that one link may bring, and of one of these steps: a sum of 1,024 links stays within a word, and light that is 10¹² times weaker
// than that of the brightest surface counts.
const float EMISSION_STEPS = 1048576.0;
const uint EMISSION_WORD = 3u;

uint arrival_words() {
    return HAS_EMITTERS != 0u ? 9u : 3u;
}

// The first word of the sky in so many specular events, one or more.
uint late_sky(uint particle_count, uint particle, uint events) {
    return particle_count * arrival_words() + 3u * ((events - 1u) * particle_count + particle);
}

#endif
