// What slots of virtual area lights matter, level by level: 4^k slots of level 0, one after the other along Morton's curve, are one node of level k. A node has how much light
// it gives to what the picture shows, and how much it reflects at all.
#ifndef CACHES_PYRAMID
#define CACHES_PYRAMID

// Where a level begins; `slot_count`: a multiple of 4 to the power of the last level.
uint first_of_level(uint slot_count, uint level) {
    uint first = 0u;
    for (uint below = 0u; below < level; ++below) {
        first += slot_count >> (2u * below);
    }
    return first;
}

// The share of the light that each texel of a light view gets, seen or not.
const float UNSEEN_SHARE = 0.125;

// Both parts over those of all.
float matter_of(vec2 node, vec2 total) {
    vec2 shares = node / max(total, vec2(1e-37));
    return total.x > 0.0 ? mix(shares.x, shares.y, UNSEEN_SHARE) : shares.y;
}

#endif
