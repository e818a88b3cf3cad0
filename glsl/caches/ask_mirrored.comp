#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "caches/asks.glsl"
#include "caches/cascades.glsl"
#include "lib/mirrored.glsl"

// One point that mirrors and glass show asks for the caches around it, as pixels do (caches/ask.comp); its normal is on the side that it is seen from.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer AskBlock { Ask asks[]; };
layout(set = 0, binding = 1) buffer HeadBlock { uint head[]; };

layout(push_constant, scalar) uniform Push {
    Cascades cascades;
    vec3 shift;      // from render space to the rays' space
    uint capacity;
} push;

#include "caches/append_ask.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Surface point = load_mirrored(mirrored_points, index).surface;
    precise vec3 position_rs = point.position_rs - push.shift;
    float next;
    int cascade = cascade_of(push.cascades, position_rs, next);
    [[dont_unroll]] for (int step = 0; step < (next > 0.0 ? 2 : 1); ++step) {
        Place place = place_in(push.cascades, cascade + step, position_rs);
        uint lowest = address_of(push.cascades, place.cascade, place.lowest);
        uint kind = max3(point.diffuse_albedo) > 0.0 ? 0u : NOT_DIFFUSE;
        append(Ask(position_rs, point.geometric_normal, lowest | kind));
    }
}
