#version 460
#include "lib/prelude.glsl"
#include "geometry/vertex.glsl"
#include "geometry/vertex_texcoords.glsl"
#include "light_views/view.glsl"

// One vertex of a textured primitive in a reflective light view.

void main() {
    gl_Position = clip_position(position, gl_InstanceIndex);
    write_vertex();
    write_texcoords();
}
