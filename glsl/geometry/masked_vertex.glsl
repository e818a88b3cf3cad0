// A vertex of an alpha-masked primitive of which only the holes matter, and what its fragments get of it (geometry/masked.glsl).
#include "groups/geometry.glsl"
#include "geometry/vertex_texcoords.glsl"

layout(location = 0) in vec3 position;
layout(location = 5) in vec4 color;

layout(location = 1) out vec4 vertex_color;
layout(location = 2) flat out uvec2 drawn;
layout(location = 5) flat out vec4 corner_color;

void write_masked_vertex() {
    vertex_color = color;
    corner_color = color;
    drawn = uvec2(gl_InstanceIndex, gl_VertexIndex);
    write_texcoords();
}
