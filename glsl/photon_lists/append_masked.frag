#version 460
#include "lib/prelude.glsl"
#include "geometry/masked.glsl"
#define NODES_ACCESS
#include "photon_lists/append.glsl"

// One fragment of an alpha-masked primitive: a node of its texel's list, unless it is a hole.

layout(location = 0) in float depth;

void main() {
    Instance instance = load_instance(instances, drawn.x);
    vec3 normal = front_normal(instance, drawn.y);
    bool there = is_there(instance);
    if (there && is_kept(normal)) {
        append(depth, normal, instance.material);
    }
}
