#version 460
#include "lib/prelude.glsl"
#define NODES_ACCESS writeonly
#include "photon_lists/append.glsl"

// One fragment of an opaque primitive: a node of its texel's list, whatever lies before it.

layout(location = 0) in float depth;
layout(location = 2) flat in uvec2 drawn;  // geometry/vertex.glsl

void main() {
    Instance instance = load_instance(instances, drawn.x);
    vec3 normal = front_normal(instance, drawn.y);
    if (is_kept(normal)) {
        append(depth, normal, instance.material);
    }
}
