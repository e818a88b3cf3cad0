#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"

// One vertex of a primitive without textures: the object's point in the camera's clip space.

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 5) in vec4 color;

layout(location = 0) out vec3 vertex_normal;
layout(location = 1) out vec4 vertex_color;
layout(location = 2) flat out uint instance_index;

void main() {
    vec3 position_rs = vec4(position, 1.0) * load_transform(instances, gl_InstanceIndex);
    gl_Position = camera.view_projection * vec4(position_rs, 1.0);
    vertex_normal = normal;
    vertex_color = (load_instance(instances, gl_InstanceIndex).flags & INSTANCE_HAS_COLORS) != 0u ? color : vec4(1.0);
    instance_index = gl_InstanceIndex;
}
