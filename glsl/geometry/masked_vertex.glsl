// A vertex of an alpha-masked primitive of which only the holes matter, and what its fragments get of it (geometry/masked.glsl).
#include "groups/geometry.glsl"
#include "geometry/vertex_texcoords.glsl"

layout(location = 0) in vec3 position;
layout(location = 5) in vec4 color;

layout(location = 1) out float vertex_alpha;
layout(location = 2) flat out uint instance_index;

void write_masked_vertex() {
    vertex_alpha = color_of_vertex(load_instance(instances, gl_InstanceIndex), color).a;
    instance_index = gl_InstanceIndex;
    write_texcoords();
}
