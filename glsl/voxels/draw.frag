#version 460
#include "lib/prelude.glsl"
#include "voxels/triangle.glsl"

// The voxels that a triangle touches in one column along its dominant axis: what is drawn proposes the column, the same test as in compute decides
// (Crassin & Green 2012 for the drawing, Schwarz & Seidel 2010 for the test).

layout(set = 0, binding = 0) uniform usamplerBuffer triangles;
layout(set = 0, binding = 1) buffer BitBlock { uint bits[]; };

layout(push_constant, scalar) uniform Push {
    VoxelGrid grid;
    uint triangle_capacity;
    uint side;
} push;

layout(location = 0) flat in int drawn;

#include "voxels/column.glsl"

void main() {
    VoxelTriangle triangle = unpacked_triangle(texelFetch(triangles, 2 * drawn), texelFetch(triangles, 2 * drawn + 1));
    int axis = dominant_axis(normal_of(triangle));
    triangle = turned_triangle(triangle, axis);
    ivec3 first = lowest(triangle) / push.grid.units;
    ivec3 last = highest(triangle) / push.grid.units;
    mark_column(triangle, normal_of(triangle), axis, ivec2(gl_FragCoord.xy), first, last, push.grid);
}
