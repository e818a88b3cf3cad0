#version 460
#include "lib/prelude.glsl"
#include "caches/cascades.glsl"
#include "caches/moves.glsl"

// One invocation a cache: where it lies. At first at its node; later it goes as far along each axis as pixels asked for on one side (caches/move.comp), less what they
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
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= min(texelFetch(head, 3).x, push.capacity)) {
        return;
    }
    uint address = texelFetch(nodes, int(index)).x;
    float cell = cell_of_cascade(push.cascades, cascade_of_address(push.cascades, address));
    if (push.moves_on == 0u) {
        positions[index] = vec4(position_of_address(push.cascades, address), cell);
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
