#version 460
#include "lib/prelude.glsl"
#include "geometry/vertex.glsl"
#include "geometry/vertex_tangent.glsl"
#include "geometry/vertex_texcoords.glsl"
#include "light_views/view.glsl"

// One vertex of a textured primitive that has a specular lobe, drawn over a light view's depth: the same place to the bit.

void main() {
    gl_Position = clip_position(position, gl_InstanceIndex);
    write_vertex();
    write_tangent();
    write_texcoords();
}
