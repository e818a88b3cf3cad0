#version 460
#include "lib/prelude.glsl"
#include "voxels/grid.glsl"

// The voxels of one row along x whose centres lie within a solid: where the winding number, the sum of the crossings before, is positive. A row that does not come out of
// all that it went into met a mesh with a crack, and is left as it is.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer crossings;
layout(set = 0, binding = 1) buffer BitBlock { uint bits[]; };

layout(push_constant, scalar) uniform Push { VoxelGrid grid; } push;

// The fields were added up as one number: what a negative one borrowed from the next comes back.
int next_crossing(inout int fields) {
    int crossing = fields << 24 >> 24;
    fields = (fields - crossing) >> 8;
    return crossing;
}

void main() {
    int row = int(gl_GlobalInvocationID.x);
    if (row >= push.grid.dims.y * push.grid.dims.z) {
        return;
    }
    int words = push.grid.dims.x / 4;
    int in_and_out = 0;
    for (int word = row * words; word < (row + 1) * words; ++word) {
        int fields = int(texelFetch(crossings, word).x);
        for (int voxel = 0; voxel < 4; ++voxel) {
            in_and_out += next_crossing(fields);
        }
    }
    if (in_and_out != 0) {
        return;
    }
    int winding = 0;
    for (int word = row * words; word < (row + 1) * words; ++word) {
        int fields = int(texelFetch(crossings, word).x);
        uint inside = 0u;
        for (int voxel = 0; voxel < 4; ++voxel) {
            winding += next_crossing(fields);
            inside |= winding > 0 ? 1u << voxel : 0u;
        }
        if (inside != 0u) {
            uint first = 4u * uint(word);
            atomicOr(bits[first >> 5], inside << (first & 31u));
        }
    }
}
