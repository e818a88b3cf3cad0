#version 460
#include "lib/prelude.glsl"
#include "caches/visibility.glsl"
#include "radiance_maps/search.glsl"

// The light of one map (search.glsl), each group of lights seen by a ray, or wholly.

layout(local_size_x = 64) in;

void main() {
    search_map();
}
