// A grid over space whose cells share a power of two of buckets: cells are two spacings wide, so that the eight around a point reach one spacing.
#ifndef PARTICLES_GRID
#define PARTICLES_GRID

const float CELL_SPACINGS = 2.0;

ivec3 cell_of(vec3 position, float spacing) {
    return ivec3(floor(position / (CELL_SPACINGS * spacing)));
}

// Neighbours along x lie in neighbouring buckets.
uint bucket_of(ivec3 cell, uint bucket_count) {
    return (uint(cell.x) + uint(cell.y) * 0x9E3779B1u + uint(cell.z) * 0x85EBCA77u) & (bucket_count - 1u);
}

#endif
