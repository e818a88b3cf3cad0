#version 460
#include "lib/prelude.glsl"

// Notes of one texel that was gathered what then came along its links: of its first round. What the later ones may add up to is bounded by that.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer list;
layout(set = 0, binding = 1) uniform usamplerBuffer head;   // word 3: how many
layout(set = 0, binding = 2) uniform samplerBuffer now;
layout(set = 0, binding = 3) uniform samplerBuffer gathered;   // the IIM; w: rounds
layout(set = 0, binding = 4) writeonly buffer Then { vec4 then[]; };

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint maps;
} push;

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place < texelFetch(head, 3).x) {
        uint number = texelFetch(list, int(place)).x;
        if (texelFetch(gathered, int(number)).w <= 1.0) {
            [[dont_unroll]] for (uint map = 0u; map < push.maps; ++map) {
                uint place_in_map = map * push.texel_count + number;
                then[place_in_map] = texelFetch(now, int(place_in_map));
            }
        }
    }
}
