#version 460
#include "lib/prelude.glsl"
#include "geometry/masked.glsl"

// One fragment of an alpha-masked primitive in a light view that holds depth alone: below the material's cutoff it is a hole.

void main() {
    if (!is_there(load_instance(instances, drawn.x))) {
        discard;
    }
}
