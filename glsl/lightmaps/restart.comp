#version 460
#include "lib/prelude.glsl"
#include "lightmaps/rounds.glsl"

// Whether one side of a surface begins its rounds anew: a light that a change touches sent photons there in any of them, or something moved where its texels look along
// it, so that they see other parts of it. Forgets where lights shone all of whose photons are sent again.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer affected;  // lights, as in affected.comp
layout(set = 0, binding = 1) uniform usamplerBuffer bounds;    // of sides, six words each
layout(set = 0, binding = 2) uniform samplerBuffer boxes;      // what moved: lowest and highest corner each
layout(set = 0, binding = 3) buffer Past { uint past[]; };     // rounds.glsl
layout(set = 0, binding = 4) buffer Touched { uint touched[]; };   // 1, by surface and side

layout(push_constant, scalar) uniform Push {
    uint side_count;
    uint light_count;  // of all kinds
    uint box_count;
} push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    uint met = texelFetch(affected, 0).x;
    uint gone = met & ~texelFetch(affected, 1).x;
    if (number < push.side_count) {
        bool restarts = (past[number] & met) != 0u;
        [[dont_unroll]] for (uint box = 0u; box < push.box_count && !restarts; ++box) {
            vec3 low = texelFetch(boxes, 2 * int(box)).xyz;
            vec3 high = texelFetch(boxes, 2 * int(box) + 1).xyz;
            restarts = meets_words(bounds, 6u * number, low, high);
        }
        if (restarts) {
            touched[number] = 1u;
        }
        past[number] &= ~gone;
    }
    if (number < push.light_count && (gone & bit_of_light(number)) != 0u) {
        [[dont_unroll]] for (uint word = 0u; word < 6u; ++word) {
            past[box_of_light(push.side_count, number) + word] = 0u;
        }
    }
}
