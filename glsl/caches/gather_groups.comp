#version 460
#include "lib/prelude.glsl"
#include "lib/color.glsl"
#include "lib/vpl.glsl"

// One invocation a group of slots: drops those without flux, in order, and finds the sphere around the others. Its middle is their mean position by flux; its radius is two
// standard deviations of where their light comes from, the spread of each light's own disc, A/2π, included. The paper takes the larger of two deviations of the depth in the
// light view (its text; eq. 4.12 prints one) and of half the width of the square; a deviation in space holds both.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer slots;
layout(set = 0, binding = 1) uniform usamplerBuffer offsets;
layout(set = 0, binding = 2) writeonly buffer LightBlock { vec4 lights[]; };
layout(set = 0, binding = 3) writeonly buffer GroupBlock { uvec4 groups[]; };

layout(push_constant, scalar) uniform Push {
    uint group_count;
    uint group_slots;
} push;

void main() {
    uint group = gl_GlobalInvocationID.x;
    if (group >= push.group_count) {
        return;
    }
    uvec2 before = texelFetch(offsets, int(group)).xy;
    uint next = before.x;
    float weights = 0.0;
    vec3 base = vec3(0.0);
    vec3 way = vec3(0.0);
    float squares = 0.0;
    float farthest = 0.0;
    [[dont_unroll]] for (uint index = 0u; index < push.group_slots; ++index) {
        int slot = int(group * push.group_slots + index);
        vec4 first = texelFetch(slots, 2 * slot);
        vec4 second = texelFetch(slots, 2 * slot + 1);
        if (max3(second.rgb) > 0.0) {
            lights[2u * next] = first;
            lights[2u * next + 1u] = second;
            ++next;
            float weight = luminance(second.rgb);
            base = weights == 0.0 ? first.xyz : base;
            vec3 off = first.xyz - base;
            weights += weight;
            way += weight * off;
            squares += weight * (dot(off, off) + 0.5 * first.w);
            farthest = max(farthest, length(off));
        }
    }
    if (next > before.x) {
        vec3 mean = way / weights;
        float radius = 2.0 * sqrt(max(squares / weights - dot(mean, mean), 0.0));
        uint count = next - before.x;
        groups[2u * before.y] = floatBitsToUint(vec4(base + mean, radius));
        groups[2u * before.y + 1u] = uvec4(before.x, count, floatBitsToUint(vec2(weights, farthest + length(mean))));
    }
}
