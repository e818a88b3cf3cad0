// Which pixel an invocation of a compute group of 64 works on.
//
// Eight consecutive local indices form a block of 4x2 pixels: the subgroup of a CPU driver with eight lanes and a good
// shape on any other, so that a branch which is uniform over 4x2 pixels skips work. The 64 invocations cover 8x8 pixels.
//
// Rows of groups run in the order 0, 2, 4, … 1, 3, 5, …: a driver that cuts a dispatch into contiguous halves, one a core,
// then gives both the same share of sky and of geometry.
#ifndef LIB_PIXELS
#define LIB_PIXELS

#include "lib/pixel_grid.glsl"

const uint GROUP_SIZE = 64u;

// `group_extent`: the pixels that one group covers, a multiple of 8x8; the invocation gets its pixel of the first 8x8.
ivec2 pixel_of_invocation(uvec2 group_extent) {
    uint lane = gl_LocalInvocationIndex & 7u;
    uint block = gl_LocalInvocationIndex >> 3;
    uvec2 in_group = uvec2((block & 1u) * 4u + (lane & 3u), (block >> 1) * 2u + (lane >> 2));
    uint even_rows = (gl_NumWorkGroups.y + 1u) / 2u;
    uint row = gl_WorkGroupID.y < even_rows ? 2u * gl_WorkGroupID.y : 2u * (gl_WorkGroupID.y - even_rows) + 1u;
    return ivec2(uvec2(gl_WorkGroupID.x, row) * group_extent + in_group);
}

ivec2 pixel_of_invocation() {
    return pixel_of_invocation(uvec2(8u));
}

#endif
