#version 460
#include "lib/prelude.glsl"
#include "gbuffer/vertex.glsl"
#include "geometry/vertex_tangent.glsl"
#include "geometry/vertex_texcoords.glsl"

// One vertex of a textured primitive: the object's point in the camera's clip space.

void main() {
    write_seen_vertex();
    write_tangent();
    write_texcoords();
}
