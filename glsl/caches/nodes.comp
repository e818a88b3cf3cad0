#version 460
#include "lib/prelude.glsl"
#include "groups/area_lights.glsl"
#include "caches/light_nodes.glsl"

// One invocation for each 4, 16 or 64 neighbouring groups of lights: the sphere around them (caches/light_nodes.glsl), as caches/gather_groups.comp has it of lights. Its middle is the mean
// of the groups' middles by flux; its radius is two deviations, of where the middles lie and of the groups' own, whose radius is two of theirs.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer NodeBlock { vec4 nodes[]; };

layout(push_constant, scalar) uniform Push {
    int group_count;
} push;

void main() {
    int number = int(gl_GlobalInvocationID.x);
    int level = 1;
    while (level < NODE_LEVELS && number >= first_node_of_level(push.group_count, level + 1)) {
        ++level;
    }
    int size = 1 << (2 * level);
    int first = (number - first_node_of_level(push.group_count, level)) * size;
    int end = min(first + size, int(texelFetch(area_light_counts, 1).x));
    if (first >= end) {
        return;
    }
    vec3 base = uintBitsToFloat(texelFetch(area_light_groups, 2 * first).xyz);
    float weights = 0.0;
    vec3 way = vec3(0.0);
    float squares = 0.0;
    [[dont_unroll]] for (int group = first; group < end; ++group) {
        vec4 sphere = uintBitsToFloat(texelFetch(area_light_groups, 2 * group));
        float weight = uintBitsToFloat(texelFetch(area_light_groups, 2 * group + 1).z);
        vec3 off = sphere.xyz - base;
        weights += weight;
        way += weight * off;
        squares += weight * (dot(off, off) + 0.25 * sphere.w * sphere.w);
    }
    vec3 mean = way / max(weights, 1e-37);
    float radius = 2.0 * sqrt(max(squares / max(weights, 1e-37) - dot(mean, mean), 0.0));
    nodes[number] = vec4(base + mean, radius);
}
