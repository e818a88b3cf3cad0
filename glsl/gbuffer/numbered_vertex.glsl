// One vertex of what the G-buffer's depth shows already, the same place to the bit, and which triangle it begins.

#include "groups/geometry.glsl"
#include "gbuffer/seen.glsl"

layout(location = 0) in vec3 position;

layout(location = 2) flat out uvec2 drawn;

void main() {
    gl_Position = seen_position(position, gl_InstanceIndex);
    drawn = uvec2(gl_InstanceIndex, gl_VertexIndex);
}
