#version 460
#include "lib/prelude.glsl"
#include "caches/visibility.glsl"
#include "volumes/light.glsl"

// The light of eight caches (light.glsl), each group of lights seen by a ray, or wholly.

layout(local_size_x = 64) in;

void main() {
    light_caches();
}
