#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "regions/regions.glsl"

// A texel of the flattened image marks the stencil if its region is valid (alg. 3.1 of Quyen 2014): the others are discarded, so that no
// export of stencil values is needed.

layout(set = 0, binding = 0) uniform sampler2D planes;

layout(push_constant, scalar) uniform Push {
    ivec2 size;         // pixels
    int level_count;
} push;

void main() {
    Region region = region_at(push.size, ivec2(gl_FragCoord.xy), push.level_count);
    if (!is_valid(depth, surface, planes, push.size, region, push.level_count)) {
        discard;
    }
}
