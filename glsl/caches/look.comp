#version 460
#include "lib/prelude.glsl"
#include "caches/asks.glsl"
#include "caches/cascades.glsl"
#include "caches/horizons.glsl"

// One invocation for each node that is asked for adds what the asking surface, if it is diffuse, has in front of it to what its cache's surfaces have (caches/horizons.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer AskBlock { Ask asks[]; };
layout(set = 0, binding = 1) uniform usamplerBuffer ask_head;
layout(set = 0, binding = 2) uniform usamplerBuffer addresses;
layout(set = 0, binding = 3) uniform samplerBuffer positions;
layout(set = 0, binding = 4) buffer HorizonBlock { uint horizons[]; };

layout(push_constant, scalar) uniform Push {
    int resolution;
    uint ask_capacity;
    uint capacity;
} push;

// Most surfaces have nothing to add to what others said before.
void raise(uint word, uint value) {
    if (horizons[word] < value) {
        atomicMax(horizons[word], value);
    }
}

void main() {
    uint number = ask_of_invocation();
    if (number >= min(texelFetch(ask_head, 3).x, push.ask_capacity)) {
        return;
    }
    Ask ask = asks[number];
    if ((ask.lowest & NOT_DIFFUSE) != 0u) {
        return;
    }
    uint address = node_of_ask(ask, push.resolution, int(gl_LocalInvocationIndex % 8u));
    uint index = texelFetch(addresses, int(address)).x - 1u;
    if (index >= push.capacity) {
        return;
    }
    vec4 place = texelFetch(positions, int(index));
    float height = dot(ask.normal, place.xyz - ask.position_rs) / place.w;
    uint first = 8u * (FACINGS * index + facing_of(ask.normal));
    for (uint axis = 0u; axis < 3u; ++axis) {
        raise(first + axis, component_steps(-ask.normal[axis]));
        raise(first + 4u + axis, component_steps(ask.normal[axis]));
    }
    raise(first + 3u, floatBitsToUint(clamp(height + HORIZON_LIFT, 1e-3, 2.0 * HORIZON_LIFT)));
}
