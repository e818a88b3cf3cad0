// A grid of cubic voxels around the scene, and the whole numbers in which triangles are held against it.
//
// A voxel is `units` long, a power of two. Corners of triangles are rounded to odd units: so none lies on the border of a voxel, which is even, and
// a wall in such a border fills one layer of voxels, not two. A coordinate has at most 14 bits, with which all products of the exact test are
// numbers of 32 bits but for the plane's (voxels/overlap.glsl).
#ifndef VOXELS_GRID
#define VOXELS_GRID

struct VoxelGrid {
    vec3 origin_rs;  // its lowest corner
    float size;      // of a voxel, m
    ivec3 dims;      // voxels along each axis, multiples of the coarsest level's voxel
    int units;       // of a voxel's length
    int levels;      // level l has voxels of 2^l
};

// From the cyclic order in which `axis` is the third, and back.
ivec3 turned(ivec3 place, int axis) {
    return axis == 0 ? place.yzx : axis == 1 ? place.zxy : place;
}

ivec3 turned_back(ivec3 place, int axis) {
    return axis == 0 ? place.zxy : axis == 1 ? place.yzx : place;
}

// The number of a voxel, x fastest.
uint voxel_number(ivec3 voxel, ivec3 dims) {
    return uint((voxel.z * dims.y + voxel.y) * dims.x + voxel.x);
}

#endif
