// Sums of a sample in a buffer `uint sums[]`, which the including shader declares: eight words, the low ones of red, green and blue, one unused, the
// high ones likewise.
#ifndef PHOTON_SPLAT_SUMS
#define PHOTON_SPLAT_SUMS

void add_to_sum(int word, uint low, uint high) {
    uint before = atomicAdd(sums[word], low);
    high += before + low < before ? 1u : 0u;
    if (high != 0u) {
        atomicAdd(sums[word + 4], high);
    }
}

// `index`: of the sample in the list of those of a range of tiles.
void add_to_sums(int index, uvec3 low, uvec3 high) {
    add_to_sum(8 * index, low.x, high.x);
    add_to_sum(8 * index + 1, low.y, high.y);
    add_to_sum(8 * index + 2, low.z, high.z);
}

#endif
