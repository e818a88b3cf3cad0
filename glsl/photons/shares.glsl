// How M photons are shared among N ≤ M blocks as evenly as whole numbers can be: block r gets those from number ⌊r·M/N⌋ on, up to the first of
// the next. M, N < 2²¹ (src/frame/photons/records.rs).
#ifndef PHOTONS_SHARES
#define PHOTONS_SHARES

// x·y/z: the whole part and the remainder, in words of 32 bits though the product has 42.
uvec2 scaled(uint x, uint y, uint z) {
    uint upper = (x >> 11) * y;
    uint carried = (upper % z) << 11;
    uint lower = (x & 2047u) * y;
    uint rest = carried % z + lower % z;
    return uvec2(((upper / z) << 11) + carried / z + lower / z + rest / z, rest % z);
}

uint first_photon_of(uint block, uint photons, uint blocks) {
    return scaled(block, photons, blocks).x;
}

uint block_of_photon(uint photon, uint photons, uint blocks) {
    uvec2 next = scaled(photon + 1u, blocks, photons);
    return next.y == 0u ? next.x - 1u : next.x;
}

#endif
