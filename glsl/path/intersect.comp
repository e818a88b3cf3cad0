#version 460
#include "lib/prelude.glsl"
#include "groups/paths.glsl"
#include "groups/scene_rays.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"

// The nearest surface along one path's ray.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer HitBlock { vec4 path_hits[]; };

#include "path/cutouts.glsl"
#include "lib/bvh.glsl"

void main() {
    uint path = queued_path(active_paths);
    if (path == NO_PATH) {
        return;
    }
    Ray ray = load_ray(path_rays, path);
    Hit hit = closest_hit(ray.origin, ray.direction, 3e38);
    path_hits[path] = vec4(hit.distance, hit.barycentric, uintBitsToFloat(hit.triangle));
}
