// The scene as voxels (src/frame/voxels/), for cones through them (lib/voxel_cones.glsl).
// group: bindings 164 to 167, constants 76 to 79
#ifndef GROUPS_VOXELS
#define GROUPS_VOXELS

#include "voxels/blocks.glsl"
#include "voxels/grid.glsl"

// 1: a cone meets opacity as it is seen along its way; 0: the mean.
layout(constant_id = 76) const uint VOXELS_SEEN_ALONG_AXES = 1u;
// 1: cones skip what is empty; 0: `voxel_distances` is not there.
layout(constant_id = 77) const uint VOXELS_SKIP_EMPTY = 0u;
// The width of a cone's samples over the cone's.
layout(constant_id = 78) const float VOXELS_CONE_WIDTH = 0.5;

layout(set = 0, binding = 164) uniform VoxelGridBlock { VoxelGrid voxel_grid; };
layout(set = 0, binding = 165) uniform sampler3D voxel_opacity;          // seen along x, y, z · mean; level l has voxels of 2^l
layout(set = 0, binding = 166) uniform usamplerBuffer voxel_distances;  // of each block from the nearest that holds anything

#endif
