// A triangle in units of the grid: nine coordinates of 16 bits in two texels (rgba32ui).
#ifndef VOXELS_TRIANGLE
#define VOXELS_TRIANGLE

#include "voxels/grid.glsl"

struct VoxelTriangle {
    ivec3 a;
    ivec3 b;
    ivec3 c;
    bool flipped;  // its front is where its corners run clockwise
};

// As it lies in a list.
struct PackedTriangle {
    uvec4 first;
    uvec4 second;
};

const uint VOXEL_TRIANGLE_FLIPPED = 1u;

PackedTriangle packed_triangle(VoxelTriangle triangle) {
    uvec3 a = uvec3(triangle.a);
    uvec3 b = uvec3(triangle.b);
    uvec3 c = uvec3(triangle.c);
    return PackedTriangle(
        uvec4(a.x | a.y << 16, a.z | b.x << 16, b.y | b.z << 16, c.x | c.y << 16),
        uvec4(c.z, triangle.flipped ? VOXEL_TRIANGLE_FLIPPED : 0u, 0u, 0u));
}

VoxelTriangle unpacked_triangle(uvec4 first, uvec4 second) {
    ivec4 low = ivec4(first & 0xFFFFu);
    ivec4 high = ivec4(first >> 16);
    return VoxelTriangle(
        ivec3(low.x, high.x, low.y), ivec3(high.y, low.z, high.z), ivec3(low.w, high.w, int(second.x)),
        (second.y & VOXEL_TRIANGLE_FLIPPED) != 0u);
}

VoxelTriangle turned_triangle(VoxelTriangle triangle, int axis) {
    return VoxelTriangle(turned(triangle.a, axis), turned(triangle.b, axis), turned(triangle.c, axis), triangle.flipped);
}

// Twice its area as a vector, in units²; at most 30 bits.
ivec3 normal_of(VoxelTriangle triangle) {
    ivec3 e = triangle.b - triangle.a;
    ivec3 f = triangle.c - triangle.a;
    return ivec3(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x);
}

// The axis along which it is seen largest.
int dominant_axis(ivec3 normal) {
    ivec3 size = abs(normal);
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

ivec3 lowest(VoxelTriangle triangle) {
    return min(triangle.a, min(triangle.b, triangle.c));
}

ivec3 highest(VoxelTriangle triangle) {
    return max(triangle.a, max(triangle.b, triangle.c));
}

#endif
