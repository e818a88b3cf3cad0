#version 460
#include "lib/prelude.glsl"
#include "caches/asking.glsl"
#include "caches/elect.glsl"

// One invocation a pixel makes the light caches that the pixel interpolates between where there are none yet: at the eight nodes around its surface, in a zone of
// transition those of both cascades (Reich 2015, sections 4.2.2 and 4.5.3). Whoever takes a node's word from 0 by compare-and-swap gives the cache its number.
// Words 0 to 2 of `head` are groups of one cache each, in rows of ROW_GROUPS; word 3 counts the caches, also those for which there is no room.

const uint ROW_GROUPS = 32768u;

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) buffer AddressBlock { uint addresses[]; };
layout(set = 0, binding = 1) buffer HeadBlock { uint head[]; };
layout(set = 0, binding = 2) writeonly buffer NodeBlock { uint nodes[]; };

layout(push_constant, scalar) uniform Push {
    Cascades cascades;
    uint capacity;
} push;

void allocate(uint address) {
    if (addresses[address] != 0u || atomicCompSwap(addresses[address], 0u, LOCKED) != 0u) {
        return;
    }
    uint index = atomicAdd(head[3], 1u);
    atomicMax(head[0], min(index + 1u, ROW_GROUPS));
    atomicMax(head[1], index / ROW_GROUPS + 1u);
    atomicMax(head[2], 1u);
    if (index < push.capacity) {
        nodes[index] = address;
        atomicExchange(addresses[address], index + 1u);
    }
}

void main() {
    ivec2 size = textureSize(depth, 0);
    Asking asking = asking_of_pixel(push.cascades, ivec2(gl_GlobalInvocationID.xy), size);
    [[dont_unroll]] for (int step = 0; step < 2; ++step) {
        bool asks = asking.asks && (step == 0 || asking.in_both);
        Place place = place_in(push.cascades, asking.cascade + (asks ? step : 0), asking.position_rs);
        uint lowest = address_of(push.cascades, place.cascade, place.lowest);
        if (elect(uvec2(asks ? lowest : NO_ADDRESS, 0u))) {
            [[dont_unroll]] for (int corner = 0; corner < 8; ++corner) {
                allocate(address_of(push.cascades, place.cascade, place.lowest + corner_of(corner)));
            }
        }
    }
}
