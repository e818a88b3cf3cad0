// A vertex of an alpha-masked primitive, seen in a view.
#include "photon_lists/draw.glsl"

layout(location = 0) in vec3 position;
layout(location = 3) in vec2 texcoord0;
layout(location = 4) in vec2 texcoord1;
layout(location = 5) in vec4 color;

layout(location = 0) out float depth;
layout(location = 1) flat out uint instance_index;
layout(location = 2) out float vertex_alpha;
layout(location = 3) out vec4 texcoords;

void main() {
    vec3 position_rs = vec4(position, 1.0) * load_transform(instances, gl_InstanceIndex);
    gl_Position = clip_position(position_rs);
    depth = linear_depth(position_rs);
    instance_index = gl_InstanceIndex;
    vertex_alpha = (load_instance(instances, gl_InstanceIndex).flags & INSTANCE_HAS_COLORS) != 0u ? color.a : 1.0;
    texcoords = vec4(texcoord0, texcoord1);
}
