#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"

// Which triangle a fragment of a view shows. Its light is looked up once the nearest one is known (hemicube/shade.comp).

layout(location = 0) flat in uint number;
layout(location = 1) in vec2 place;

layout(location = 0) out uint seen;

void main() {
    if (ALPHA_MASKS != 0u && !accepts_hit(number, place)) {
        discard;
    }
    seen = number;
}
