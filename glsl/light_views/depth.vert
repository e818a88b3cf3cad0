#version 460
#include "lib/prelude.glsl"
#include "light_views/view.glsl"

// One vertex of an opaque primitive in a light view that holds depth alone: a shadow map (Williams 1978).

layout(location = 0) in vec3 position;

void main() {
    gl_Position = clip_position(position, gl_InstanceIndex);
}
