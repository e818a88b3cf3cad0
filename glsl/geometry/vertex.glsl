// A vertex of a primitive that is shaded, and what its fragments get of it.
#include "groups/geometry.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 5) in vec4 color;

layout(location = 0) out vec3 vertex_normal;
layout(location = 1) out vec4 vertex_color;
layout(location = 2) flat out uvec2 drawn;  // the instance and, of a triangle, the first vertex (face_normal)
layout(location = 5) flat out vec4 corner_color;

void write_vertex() {
    vertex_normal = normal;
    vertex_color = color;
    corner_color = color;
    drawn = uvec2(gl_InstanceIndex, gl_VertexIndex);
}
