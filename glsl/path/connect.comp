#version 460
#include "lib/prelude.glsl"
#include "groups/connections.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_rays.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"

// Adds what one vertex gets from the light that `light` chose, if nothing is in between.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer RadianceBlock { vec4 path_radiance[]; };

layout(push_constant, scalar) uniform Push {
    uint path_count;
    uint reserved;
} push;

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

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
    uint place = floatBitsToUint(direction.w) * push.path_count + path;
    int light = SPECULAR_LOBES == 0u ? int(path) : 2 * int(path);
    path_radiance[place] += texelFetch(connection_light, light);
    if (SPECULAR_LOBES != 0u) {
        vec4 caustics = texelFetch(connection_light, light + 1);
        if (caustics.x + caustics.y + caustics.z > 0.0) {
            path_radiance[SLOT_CAUSTICS * push.path_count + path] += caustics;
        }
    }
}
