// One vertex of what a light view's depth shows already, the same place to the bit, and which triangle it begins.

#include "light_views/view.glsl"

layout(location = 0) in vec3 position;

layout(location = 2) flat out uvec2 drawn;

void main() {
    gl_Position = clip_position(position, gl_InstanceIndex);
    drawn = uvec2(gl_InstanceIndex, gl_VertexIndex);
}
