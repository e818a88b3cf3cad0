#version 460
#include "lib/prelude.glsl"
#include "geometry/masked.glsl"
#include "photon_lists/peel.glsl"

// One fragment of an alpha-masked primitive in a pass of depth peeling: it stands if it is no hole and behind the layer before.

layout(location = 0) in float depth;

void main() {
    Instance instance = load_instance(instances, drawn.x);
    vec3 normal = front_normal(instance, drawn.y);
    bool there = is_there(instance);
    if (!there || !is_next(depth) || !is_kept(normal)) {
        discard;
    }
    write_layer(depth, normal, instance.material);
}
