#version 460
#include "lib/prelude.glsl"
#include "caches/asking.glsl"
#include "caches/asks.glsl"
#include "caches/speaking.glsl"
#include "lib/octahedral.glsl"

// One invocation a pixel asks for the caches that it will interpolate between: the eight nodes around its surface, in a zone of transition those of both cascades (Reich 2015,
// sections 4.2.2 and 4.5.3). Of pixels of a group of 8×8 that ask for the same nodes for surfaces that face about the same way some speak for all (caches/speaking.glsl).

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) writeonly buffer AskBlock { Ask asks[]; };
layout(set = 0, binding = 1) buffer HeadBlock { uint head[]; };

layout(push_constant, scalar) uniform Push {
    Cascades cascades;
    uint capacity;
} push;

#include "caches/append_ask.glsl"

// What is asked for in one cascade, and which of 16 × 8 directions the surface faces about, in a word: addresses have 24 bits. NO_ADDRESS: nothing is.
uint wish(int cascade, vec3 position_rs, uint kind, uint packed_normal) {
    Place place = place_in(push.cascades, cascade, position_rs);
    uint facing = packed_normal >> 28 << 3 | (packed_normal >> 13 & 7u);
    return address_of(push.cascades, place.cascade, place.lowest) | facing << 24 | kind;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = textureSize(depth, 0);
    Asking asking = asking_of_pixel(push.cascades, pixel, size);
    uint wishes[2] = uint[](NO_ADDRESS, NO_ADDRESS);
    uint packed_normal = 0u;
    if (asking.asks) {
        uvec4 packed_surface = texelFetch(surface, pixel, 0);
        packed_normal = packed_surface.y;
        uint kind = packed_surface.z != 0u || (packed_surface.w & 0xFFFFu) != 0u ? 0u : NOT_DIFFUSE;
        wishes[0] = wish(asking.cascade, asking.position_rs, kind, packed_normal);
        if (asking.in_both) {
            wishes[1] = wish(asking.cascade + 1, asking.position_rs, kind, packed_normal);
        }
    }
    say(gl_LocalInvocationID.xy, 0, wishes[0]);
    say(gl_LocalInvocationID.xy, 1, wishes[1]);
    barrier();
    for (int step = 0; step < 2; ++step) {
        if (wishes[step] != NO_ADDRESS && speaks(gl_LocalInvocationID.xy, step, wishes[step])) {
            vec3 normal = unpack_direction(packed_normal);
            bool away = dot(normal, direction_to_eye(camera, asking.position_rs)) < 0.0;
            append(Ask(asking.position_rs, away ? -normal : normal, wishes[step] & (0xFFFFFFu | NOT_DIFFUSE)));
        }
    }
}
