#version 460
#include "lib/prelude.glsl"
#include "lightmaps/rounds.glsl"

// Which lights a change touches: some of their groups have to be sent again, or something moved where photons of any of their rounds went.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer stale;   // by group
layout(set = 0, binding = 1) uniform usamplerBuffer past;    // rounds.glsl
layout(set = 0, binding = 2) uniform samplerBuffer boxes;    // what moved: lowest and highest corner each
layout(set = 0, binding = 3) buffer Affected { uint affected[]; };   // bits of lights: those touched; those that keep some group

layout(push_constant, scalar) uniform Push {
    uint group_count;
    uint groups_a_light;
    uint side_count;
    uint box_count;
} push;

bool met(uint light) {
    bool found = false;
    [[dont_unroll]] for (uint box = 0u; box < push.box_count; ++box) {
        vec3 low = texelFetch(boxes, 2 * int(box)).xyz;
        vec3 high = texelFetch(boxes, 2 * int(box) + 1).xyz;
        found = found || meets_words(past, box_of_light(push.side_count, light), low, high);
    }
    return found;
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.group_count) {
        return;
    }
    bool again = texelFetch(stale, int(number)).x != 0u;
    uint bit = bit_of_light(number / push.groups_a_light);
    atomicOr(affected[again ? 0 : 1], bit);
    if (!again && number % push.groups_a_light == 0u && met(number / push.groups_a_light)) {
        atomicOr(affected[0], bit);
    }
}
