#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"

// The nearest hit of each ray of a list, where flagged triangles are cut away beyond half their height over corner 1, and
// beside it whether anything blocks the ray.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer rays;  // origin, t_max; direction, unused

bool accepts_hit(uint triangle, vec2 barycentric) {
    return barycentric.x <= 0.5;
}

#define BVH_ACCEPTS_HITS
#include "lib/bvh.glsl"

struct MaskedHit {
    Hit hit;
    uint blocked;
};

layout(set = 0, binding = 1) writeonly buffer Hits { MaskedHit hits[]; };

void main() {
    int ray = int(gl_GlobalInvocationID.x);
    if (2 * ray >= textureSize(rays)) {
        return;
    }
    vec4 origin = texelFetch(rays, 2 * ray);
    vec3 direction = texelFetch(rays, 2 * ray + 1).xyz;
    hits[ray].hit = closest_hit(origin.xyz, direction, origin.w);
    hits[ray].blocked = is_occluded(origin.xyz, direction, origin.w) ? 1u : 0u;
}
