#version 460
#include "lib/prelude.glsl"
#include "lib/append.glsl"

// Lists the numbers of the invocations whose bit of `wanted` is set. Words 0 and 1: the list's length, counted and as the last to append saw it.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer List { uint list[]; };

layout(push_constant, scalar) uniform Push {
    uint wanted;  // of each 32 invocations
    uint count;
} push;

void main() {
    uint self = gl_GlobalInvocationID.x;
    bool wanted = self < push.count && (push.wanted >> (self & 31u) & 1u) != 0u;
    uint place;
    APPEND(list[0], wanted, place, atomicMax(list[1], new_length))
    if (wanted) {
        list[2u + place] = self;
    }
}
