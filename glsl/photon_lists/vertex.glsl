// A vertex of an opaque primitive, seen in a view.
#include "photon_lists/draw.glsl"

layout(location = 0) in vec3 position;

layout(location = 0) out float depth;
layout(location = 2) flat out uvec2 drawn;

void main() {
    vec3 position_rs = vec4(position, 1.0) * load_transform(instances, gl_InstanceIndex);
    gl_Position = clip_position(position_rs);
    depth = linear_depth(position_rs);
    drawn = uvec2(gl_InstanceIndex, gl_VertexIndex);
}
