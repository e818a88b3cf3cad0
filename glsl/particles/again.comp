#version 460
#include "lib/prelude.glsl"
#include "particles/again.glsl"

// How many groups a list of what is to be done again takes (again.glsl).

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) buffer Head { uint head[]; };

layout(push_constant, scalar) uniform Push {
    uint capacity;    // of the list
    uint count;       // of all that there is
    uint group_size;  // of the pass that does it
} push;

void main() {
    uint listed = head[AGAIN_COUNT];
    bool all = listed > push.capacity;
    uint groups = ((all ? push.count : listed) + push.group_size - 1u) / push.group_size;
    head[0] = min(groups, MOST_GROUPS);
    head[1] = (groups + MOST_GROUPS - 1u) / MOST_GROUPS;
    head[2] = 1u;
    head[ALL_AGAIN] = all ? 1u : 0u;
}
