#version 460
#include "lib/prelude.glsl"
#include "geometry/masked_vertex.glsl"
#include "light_views/view.glsl"

// One vertex of an alpha-masked primitive in a light view that holds depth alone.

void main() {
    gl_Position = clip_position(position, gl_InstanceIndex);
    write_masked_vertex();
}
