#version 460
#include "lib/prelude.glsl"
#include "light_views/view.glsl"

// One vertex of an alpha-masked primitive in a light view that holds depth alone.

layout(location = 0) in vec3 position;
layout(location = 3) in vec2 texcoord0;
layout(location = 4) in vec2 texcoord1;
layout(location = 5) in vec4 color;

layout(location = 0) out float vertex_alpha;
layout(location = 1) out vec4 texcoords;
layout(location = 2) flat out uint material_index;

void main() {
    gl_Position = clip_position(position, gl_InstanceIndex);
    vertex_alpha = (load_instance(instances, gl_InstanceIndex).flags & INSTANCE_HAS_COLORS) != 0u ? color.a : 1.0;
    texcoords = vec4(texcoord0, texcoord1);
    material_index = load_instance(instances, gl_InstanceIndex).material;
}
