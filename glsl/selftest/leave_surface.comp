#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"

// For each ray of a list that hits something: whether a ray mirrored at the surface, from where `offset_ray_origin` puts it, is
// blocked at once, and how far that is from the hit.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer rays;     // origin, t_max; direction, unused
layout(set = 0, binding = 1) uniform samplerBuffer corners;  // three a triangle, in the order of the host's list

#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"

struct Leaving {
    uint hit;
    uint blocked;
    float offset;
};

layout(set = 0, binding = 2) writeonly buffer Leavings { Leaving leavings[]; };

void main() {
    int ray = int(gl_GlobalInvocationID.x);
    if (2 * ray >= textureSize(rays)) {
        return;
    }
    vec4 origin = texelFetch(rays, 2 * ray);
    vec3 direction = texelFetch(rays, 2 * ray + 1).xyz;
    Hit hit = closest_hit(origin.xyz, direction, origin.w);
    Leaving leaving = Leaving(0u, 0u, 0.0);
    if (hit.triangle != NO_TRIANGLE) {
        int first = 3 * int(hit.triangle);
        vec3 corner = texelFetch(corners, first).xyz;
        vec3 edge1 = texelFetch(corners, first + 1).xyz - corner;
        vec3 edge2 = texelFetch(corners, first + 2).xyz - corner;
        vec3 position = corner + hit.barycentric.x * edge1 + hit.barycentric.y * edge2;
        // Edges of length 1, so that no product of lengths under- or overflows.
        vec3 normal = normalize(cross(normalize(edge1), normalize(edge2)));
        normal = dot(normal, direction) > 0.0 ? -normal : normal;
        vec3 start = offset_ray_origin(position, normal);
        leaving = Leaving(1u, is_occluded(start, reflect(direction, normal), origin.w) ? 1u : 0u, distance(position, start));
    }
    leavings[ray] = leaving;
}
