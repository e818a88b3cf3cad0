// A vertex of a primitive without textures, seen by a light and shaded.
#include "geometry/vertex.glsl"
#include "light_views/view.glsl"

void main() {
    gl_Position = clip_position(position, gl_InstanceIndex);
    write_vertex();
}
