#version 460
#include "lib/prelude.glsl"
#include "caches/asking.glsl"
#include "caches/asks.glsl"
#include "lib/octahedral.glsl"

// One invocation a pixel asks for the caches that it will interpolate between: the eight nodes around its surface, in a zone of transition those of both cascades (Reich 2015,
// sections 4.2.2 and 4.5.3). Of pixels of a group of 8×8 that ask for the same nodes for surfaces that face about the same way, only the ones without such a neighbour to the
// left, above, or left above speak. From any other pixel these steps lead to one that speaks, so that no node is forgotten. (The listing of 4.5.3 clamps the neighbour's
// place to the tile: a pixel of its first row or column then finds itself there and keeps silent.)

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) writeonly buffer AskBlock { Ask asks[]; };
layout(set = 0, binding = 1) buffer HeadBlock { uint head[]; };

layout(push_constant, scalar) uniform Push {
    Cascades cascades;
    uint capacity;
} push;

shared uvec2 asked[64];
shared uint in_both_count;

#include "caches/append_ask.glsl"

// All invocations of the group must come here.
bool speaks(uvec2 key) {
    uint self = gl_LocalInvocationIndex;
    asked[self] = key;
    barrier();
    bvec2 inside = greaterThan(gl_LocalInvocationID.xy, uvec2(0u));
    bool left = inside.x && asked[self - 1u] == key;
    bool above = inside.y && asked[self - 8u] == key;
    bool left_above = all(inside) && asked[self - 9u] == key;
    barrier();
    return key.x != NO_ADDRESS && !left && !above && !left_above;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = textureSize(depth, 0);
    Asking asking = asking_of_pixel(push.cascades, pixel, size);
    uvec4 packed_surface = asking.asks ? texelFetch(surface, pixel, 0) : uvec4(0u);
    uint packed_normal = packed_surface.y;
    uint kind = packed_surface.z != 0u || (packed_surface.w & 0xFFFFu) != 0u ? 0u : NOT_DIFFUSE;
    // 16 × 16 directions.
    uint facing = packed_normal & 0xF000F000u;

    if (gl_LocalInvocationIndex == 0u) {
        in_both_count = 0u;
    }
    barrier();
    if (asking.in_both) {
        atomicAdd(in_both_count, 1u);
    }
    barrier();
    int steps = in_both_count > 0u ? 2 : 1;
    [[dont_unroll]] for (int step = 0; step < steps; ++step) {
        bool asks = asking.asks && (step == 0 || asking.in_both);
        Place place = place_in(push.cascades, asking.cascade + (asks ? step : 0), asking.position_rs);
        uint lowest = address_of(push.cascades, place.cascade, place.lowest);
        if (speaks(uvec2(asks ? lowest | kind : NO_ADDRESS, facing))) {
            vec3 normal = unpack_direction(packed_normal);
            bool away = dot(normal, direction_to_eye(camera, asking.position_rs)) < 0.0;
            append(Ask(asking.position_rs, away ? -normal : normal, lowest | kind));
        }
    }
}
