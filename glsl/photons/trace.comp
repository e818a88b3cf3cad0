#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"

// The nearest surface on one photon's way, by the scene's hierarchy (lib/bvh.glsl): exact, where lists of pixels are not.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer rays;
layout(set = 0, binding = 1) uniform usamplerBuffer counts;
layout(set = 0, binding = 2) writeonly buffer HitBlock { uint hits[]; };

layout(push_constant, scalar) uniform Push {
    vec3 shift;  // from render space to the hierarchy's
    uint stage;
} push;

#include "path/cutouts.glsl"
#include "lib/bvh.glsl"
#include "photons/records.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(counts, int(push.stage * STAGE_WORDS + COUNT_WORD)).x) {
        return;
    }
    PhotonRay photon = load_photon_ray(rays, index);
    Hit hit = closest_hit(photon.origin_rs + push.shift, photon.direction, 3e38);
    uvec4 record = uvec4(HIT_NONE, 0u, 0u, NO_TRIANGLE);
    if (hit.triangle != NO_TRIANGLE) {
        Triangle triangle = load_triangle(triangles, hit.triangle);
        record = uvec4(floatBitsToUint(hit.distance), pack_direction(front_normal(triangle)), triangle.material, hit.triangle);
    }
    hits[4u * index] = record.x;
    hits[4u * index + 1u] = record.y;
    hits[4u * index + 2u] = record.z;
    hits[4u * index + 3u] = record.w;
}
