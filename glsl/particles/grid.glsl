// A grid over space whose cells share a power of two of buckets. Particles of different spacings are in grids of their own, level by level: cells are two spacings wide,
// the widest of the level, so that the eight around a point reach one spacing.
#ifndef PARTICLES_GRID
#define PARTICLES_GRID

const float CELL_SPACINGS = 2.0;

// The widest spacing of a level, over that of the first one.
float widest_of_level(uint level, float spacing) {
    return spacing * float(1u << level);
}

// Of that level's `spacing`.
ivec3 cell_of(vec3 position, float spacing) {
    return ivec3(floor(position / (CELL_SPACINGS * spacing)));
}

// Neighbours along x lie in neighbouring buckets.
uint bucket_of(ivec3 cell, uint level, uint bucket_count) {
    return (uint(cell.x) + uint(cell.y) * 0x9E3779B1u + uint(cell.z) * 0x85EBCA77u + level * 0xC2B2AE3Du) & (bucket_count - 1u);
}

#endif
