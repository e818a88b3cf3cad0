#version 460
#include "lib/prelude.glsl"
#include "photon_lists/peel.glsl"

// One fragment of an opaque primitive in a pass of depth peeling (Everitt 2001; Krüger et al. 2006): it stands if it is behind the layer before.

layout(location = 0) in float depth;
layout(location = 2) flat in uvec2 drawn;  // geometry/vertex.glsl

void main() {
    Instance instance = load_instance(instances, drawn.x);
    vec3 normal = front_normal(instance, drawn.y);
    if (!is_next(depth) || !is_kept(normal)) {
        discard;
    }
    write_layer(depth, normal, instance.material);
}
