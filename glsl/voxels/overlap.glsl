// Whether a triangle touches a box, exactly, in whole numbers: the separating axes of Akenine-Möller 2001 as edge functions in three projections
// (Schwarz & Seidel 2010, section 3.1) and the triangle's plane. Edges and planes that touch the box's border count.
//
// Two convex figures in a plane are apart if and only if one of them lies beyond an edge of the other; edges of the square are the boxes of both, which the
// callers' loops hold to. A triangle that is seen as a line has its edges in both directions, a point has none.
#ifndef VOXELS_OVERLAP
#define VOXELS_OVERLAP

#include "voxels/triangle.glsl"

// The edge function of a → b, positive inside where `turn` is 1 or −1 as the corners run, at the square's corner where it is greatest.
bool beyond_edge(ivec2 a, ivec2 b, int turn, ivec2 low, int size) {
    ivec2 inwards = turn * ivec2(a.y - b.y, b.x - a.x);
    ivec2 way = low - a;
    return inwards.x * way.x + inwards.y * way.y + size * (max(inwards.x, 0) + max(inwards.y, 0)) < 0;
}

// Whether no edge of the triangle, seen in a plane, has the square at `low` beyond it. `area`: as it is seen, with its sign.
bool within_edges(ivec2 a, ivec2 b, ivec2 c, int area, ivec2 low, int size) {
    int turn = area < 0 ? -1 : 1;
    return !beyond_edge(a, b, turn, low, size) && !beyond_edge(b, c, turn, low, size) && !beyond_edge(c, a, turn, low, size);
}

// Numbers of 64 bits.
struct Wide {
    int high;
    uint low;
};

Wide wide_product(int a, int b) {
    int high;
    int low;
    imulExtended(a, b, high, low);
    return Wide(high, uint(low));
}

Wide wide_sum(Wide a, Wide b) {
    uint carry;
    uint low = uaddCarry(a.low, b.low, carry);
    return Wide(a.high + b.high + int(carry), low);
}

Wide wide_dot(ivec3 a, ivec3 b) {
    return wide_sum(wide_sum(wide_product(a.x, b.x), wide_product(a.y, b.y)), wide_product(a.z, b.z));
}

// Whether the plane through `point` passes through the box: not all of it lies on one side.
bool plane_meets(ivec3 point, ivec3 normal, ivec3 low, int size) {
    ivec3 ahead = ivec3(greaterThan(normal, ivec3(0))) * size;
    Wide most = wide_dot(normal, low + ahead - point);
    Wide least = wide_dot(normal, low + size - ahead - point);
    return most.high >= 0 && (least.high < 0 || (least.high == 0 && least.low == 0u));
}

// What is left to ask of a box whose column along the third axis the triangle touches as seen along that axis, and whose range along it too.
bool touches(VoxelTriangle triangle, ivec3 normal, ivec3 low, int size) {
    return plane_meets(triangle.a, normal, low, size)
           && within_edges(triangle.a.yz, triangle.b.yz, triangle.c.yz, normal.x, low.yz, size)
           && within_edges(triangle.a.zx, triangle.b.zx, triangle.c.zx, normal.y, low.zx, size);
}

#endif
