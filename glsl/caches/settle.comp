#version 460
#include "lib/prelude.glsl"
#include "caches/cascades.glsl"
#include "caches/moves.glsl"
#include "lib/sobol.glsl"

// One invocation a cache: where it lies. At first at its node, or off it along each axis by up to `jitter` cells (Reich 2015, section 6.3, names jittered alignments as a cure for
// jagged borders of shadows), at a place that is the node's own in all frames; later it goes as far along each axis as pixels asked for on one side (caches/move.comp), less what they
// asked for on the other, and what they ask for starts anew.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer head;
layout(set = 0, binding = 1) uniform usamplerBuffer nodes;
layout(set = 0, binding = 2) buffer MoveBlock { uint moves[]; };
layout(set = 0, binding = 3) buffer PositionBlock { vec4 positions[]; };

layout(push_constant, scalar) uniform Push {
    Cascades cascades;
    uint capacity;
    uint moves_on;  // 0: it is put at its node
    float jitter;
} push;

// From −1 to 1, by the node's number from the anchor.
vec3 way_off_node(ivec3 node, int cascade) {
    uint seed = mix_bits(uint(node.x) ^ mix_bits(uint(node.y) ^ mix_bits(uint(node.z) ^ mix_bits(uint(cascade)))));
    uvec3 bits = uvec3(seed, mix_bits(seed ^ 0x9E3779B9u), mix_bits(seed ^ 0x85EBCA6Bu));
    return vec3(bits >> 8) / 8388607.5 - 1.0;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= min(texelFetch(head, 3).x, push.capacity)) {
        return;
    }
    uint address = texelFetch(nodes, int(index)).x;
    float cell = cell_of_cascade(push.cascades, cascade_of_address(push.cascades, address));
    if (push.moves_on == 0u) {
        ivec3 node = node_of_address(push.cascades, address);
        vec3 off = push.jitter * cell * way_off_node(node, cascade_of_address(push.cascades, address));
        positions[index] = vec4(push.cascades.anchor_rs + vec3(node) * cell + off, cell);
        return;
    }
    vec3 steps;
    for (uint axis = 0u; axis < 3u; ++axis) {
        uint place = 6u * index + 2u * axis;
        steps[axis] = float(moves[place]) - float(moves[place + 1u]);
        moves[place] = 0u;
        moves[place + 1u] = 0u;
    }
    positions[index].xyz += steps * (cell / MOVE_STEPS);
}
