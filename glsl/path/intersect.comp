#version 460
#include "lib/prelude.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"

// The nearest surface along one path's ray.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer active_paths;
layout(set = 0, binding = 1) uniform samplerBuffer path_rays;
layout(set = 0, binding = 2) uniform usamplerBuffer bvh_nodes;
layout(set = 0, binding = 3) uniform samplerBuffer bvh_triangles;
layout(set = 0, binding = 4) writeonly buffer HitBlock { vec4 path_hits[]; };

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
