#version 460
#include "lib/prelude.glsl"
#include "gbuffer/vertex.glsl"

// One vertex of a primitive without textures: the object's point in the camera's clip space.

void main() {
    write_seen_vertex();
}
