#version 460
#include "lib/prelude.glsl"
#include "photon_lists/peel.glsl"

// One fragment of an opaque primitive in a pass of depth peeling (Everitt 2001; Krüger et al. 2006): it stands if it is behind the layer before.

layout(location = 0) in float depth;
layout(location = 2) flat in uint instance_index;

void main() {
    Instance instance = load_instance(instances, instance_index);
    vec3 normal = front_normal(instance, gl_PrimitiveID);
    if (!is_next(depth) || !is_kept(normal)) {
        discard;
    }
    write_layer(depth, normal, instance.material);
}
