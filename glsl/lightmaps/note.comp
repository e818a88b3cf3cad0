#version 460
#include "lib/prelude.glsl"

// Notes of one texel that was gathered what then came along its links.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer list;
layout(set = 0, binding = 1) uniform usamplerBuffer head;   // word 3: how many
layout(set = 0, binding = 2) uniform samplerBuffer now;
layout(set = 0, binding = 3) writeonly buffer Then { vec4 then[]; };

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place < texelFetch(head, 3).x) {
        uint number = texelFetch(list, int(place)).x;
        then[number] = texelFetch(now, int(number));
    }
}
