#version 460
#include "lib/prelude.glsl"
#include "groups/connections.glsl"
#include "groups/scene_rays.glsl"
#include "lib/finite.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"

// Adds what one light path's vertex sends to the camera to its pixel, if nothing is in between. Sums are 64-bit integers in two
// words, in units of 1/`scale`: whatever the order of the additions, the same sum. What is no number is left out and counted in the last
// word but one.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer SplatBlock { uint splats[]; };

layout(push_constant, scalar) uniform Push {
    float scale;
    uint reserved;
} push;

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

void add(uint place, float light) {
    float units = min(light * push.scale, 1e18);
    uint high = uint(units * (1.0 / 4294967296.0));
    uint low = uint(units - float(high) * 4294967296.0);
    uint before = atomicAdd(splats[place], low);
    high += before + low < before ? 1u : 0u;
    if (high != 0u) {
        atomicAdd(splats[place + 1u], high);
    }
}

void main() {
    uint path = queued_path(connections);
    if (path == NO_PATH) {
        return;
    }
    vec4 origin = texelFetch(connection_rays, 2 * int(path));
    vec4 direction = texelFetch(connection_rays, 2 * int(path) + 1);
    if (is_occluded(origin.xyz, direction.xyz, origin.w)) {
        return;
    }
    vec3 light = texelFetch(connection_light, 2 * int(path)).xyz;
    if (!is_finite(light)) {
        atomicAdd(splats[splats.length() - 2], 1u);
        return;
    }
    uint place = 6u * floatBitsToUint(direction.w);
    add(place, light.x);
    add(place + 2u, light.y);
    add(place + 4u, light.z);
}
