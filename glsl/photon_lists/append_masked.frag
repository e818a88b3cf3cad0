#version 460
#include "lib/prelude.glsl"
#define NODES_ACCESS
#include "photon_lists/append.glsl"
#include "photon_lists/masked.glsl"

// One fragment of an alpha-masked primitive: a node of its texel's list, unless it is a hole.

layout(location = 0) in float depth;
layout(location = 1) flat in uint instance_index;
layout(location = 2) in float vertex_alpha;
layout(location = 3) in vec4 texcoord_sets;

void main() {
    Instance instance = load_instance(instances, instance_index);
    vec3 normal = front_normal(instance, gl_PrimitiveID);
    bool there = is_there(instance.material, vertex_alpha, texcoord_sets);
    if (there && is_kept(normal)) {
        append(depth, normal, instance.material);
    }
}
