#version 460
#include "lib/prelude.glsl"
#include "photon_lists/draw.glsl"

// One vertex of an opaque primitive in a view that layers are peeled from.

layout(location = 0) in vec3 position;

layout(location = 0) out float depth;
layout(location = 1) flat out uint instance_index;

void main() {
    vec3 position_rs = vec4(position, 1.0) * load_transform(instances, gl_InstanceIndex);
    gl_Position = clip_position(position_rs);
    depth = linear_depth(position_rs);
    instance_index = gl_InstanceIndex;
}
