#version 460
#include "lib/prelude.glsl"
#include "groups/scene_lights.glsl"
#include "lib/sobol.glsl"

// Whether one group of photons has to be sent again because its light is another one now. Emissive surfaces count as one light, whose photons start anew with them, and so
// does the sky, whose name the host says.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Stale { uint stale[]; };  // by group
layout(set = 0, binding = 1) buffer Keys { uint keys[]; };              // of the light that the group was sent from
layout(set = 0, binding = 2) writeonly buffer Among { uint among[]; };  // a word whose content the host names by the surfaces

layout(push_constant, scalar) uniform Push {
    uint group_count;
    uint groups_a_light;
    uint light_count;  // punctual
    uint sky_key;
    uint all;          // 1: all groups are
} push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number == 0u) {
        among[0] = push.group_count;
    }
    if (number >= push.group_count) {
        return;
    }
    uint light = number / push.groups_a_light;
    uint key = push.sky_key;
    if (light < push.light_count) {
        key = 0u;
        [[dont_unroll]] for (int texel = 0; texel < 4; ++texel) {
            uvec4 words = texelFetch(punctual_lights, 4 * int(light) + texel);
            key = seed_of(seed_of(seed_of(seed_of(key, words.x), words.y), words.z), words.w);
        }
    }
    stale[number] = push.all != 0u || keys[number] != key ? 1u : 0u;
    keys[number] = key;
}
