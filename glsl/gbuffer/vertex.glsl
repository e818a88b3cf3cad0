// A vertex as the camera sees it.
#include "geometry/vertex.glsl"
#include "gbuffer/seen.glsl"

void write_seen_vertex() {
    gl_Position = seen_position(position, gl_InstanceIndex);
    write_vertex();
}
