#version 460
#include "lib/prelude.glsl"
#include "caches/asks.glsl"
#include "caches/cascades.glsl"

// One invocation for each node that is asked for makes a light cache there if there is none yet. Whoever takes the node's word from 0 by compare-and-swap gives the cache its
// number (Reich 2015, section 4.5.3). Words 0 to 2 of `head` are groups of GROUP_CACHES caches, in rows of ROW_GROUPS; word 3 counts the caches, also those for which there is no
// room.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer AskBlock { Ask asks[]; };
layout(set = 0, binding = 1) uniform usamplerBuffer ask_head;
layout(set = 0, binding = 2) buffer AddressBlock { uint addresses[]; };
layout(set = 0, binding = 3) buffer HeadBlock { uint head[]; };
layout(set = 0, binding = 4) writeonly buffer NodeBlock { uint nodes[]; };

layout(push_constant, scalar) uniform Push {
    int resolution;
    uint ask_capacity;
    uint capacity;
} push;

void main() {
    uint ask = ask_of_invocation();
    if (ask >= min(texelFetch(ask_head, 3).x, push.ask_capacity)) {
        return;
    }
    uint address = node_of_ask(asks[ask], push.resolution, int(gl_LocalInvocationIndex % 8u));
    if (addresses[address] != 0u || atomicCompSwap(addresses[address], 0u, LOCKED) != 0u) {
        return;
    }
    uint index = atomicAdd(head[3], 1u);
    uint group = index / GROUP_CACHES;
    atomicMax(head[0], min(group + 1u, ROW_GROUPS));
    atomicMax(head[1], group / ROW_GROUPS + 1u);
    atomicMax(head[2], 1u);
    if (index < push.capacity) {
        nodes[index] = address;
        atomicExchange(addresses[address], index + 1u);
    }
}
