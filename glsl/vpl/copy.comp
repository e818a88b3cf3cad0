#version 460
#include "lib/prelude.glsl"

// One invocation takes one texel of the first bounce's virtual point lights over into the list of those of all bounces.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer first_bounce;
layout(set = 0, binding = 1) writeonly buffer Vpls { vec4 vpls[]; };

layout(push_constant, scalar) uniform Push { uint texel_count; } push;

void main() {
    uint texel = gl_GlobalInvocationID.x;
    if (texel < push.texel_count) {
        vpls[texel] = texelFetch(first_bounce, int(texel));
    }
}
