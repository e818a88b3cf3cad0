#version 460
#include "lib/prelude.glsl"
#define NODES_ACCESS writeonly
#include "photon_lists/append.glsl"

// One fragment of an opaque primitive: a node of its texel's list, whatever lies before it.

layout(location = 0) in float depth;
layout(location = 2) flat in uint instance_index;

void main() {
    Instance instance = load_instance(instances, instance_index);
    vec3 normal = front_normal(instance, gl_PrimitiveID);
    if (is_kept(normal)) {
        append(depth, normal, instance.material);
    }
}
