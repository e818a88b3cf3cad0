#version 460
#include "lib/prelude.glsl"

// The light of one texel of all maps together, each times its light's colour: E = Σ_m t_m·E_m        W/m²

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer light;   // by map and texel
layout(set = 0, binding = 1) uniform samplerBuffer tints;   // by map
layout(set = 0, binding = 2) writeonly buffer Combined { vec4 combined[]; };

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint maps;
} push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint map = 0u; map < push.maps; ++map) {
        sum += texelFetch(tints, int(map)).rgb * texelFetch(light, int(map * push.texel_count + number)).rgb;
    }
    combined[number] = vec4(sum, 1.0);
}
