#version 460
#include "lib/prelude.glsl"
#include "caches/cone_visibility.glsl"
#include "radiance_maps/write.glsl"

// The light of one map (write.glsl), each group of lights seen by a cone through voxels.

layout(local_size_x = 64) in;

void main() {
    write_map();
}
