// Rays that start on a surface.
#ifndef LIB_RAY_OFFSET
#define LIB_RAY_OFFSET

#include "groups/scene_rays.glsl"

// Moves a point of a surface to the side that the normal points to, so far that rounding does not leave it on the other one: 16 units in the last place of its
// own coordinates (Wächter & Binder, Ray Tracing Gems, ch. 6). What rounding of far corners does is known where a triangle is met (lib/bvh.glsl). Their constants
// for points near the origin are replaced by the last word of the hierarchy, a length by the size of what matters and of its finer triangles
// (src/frame/rays/traced_scene.rs), so that no unit of length matters.
vec3 offset_ray_origin(vec3 position, vec3 normal) {
    vec3 size = abs(position);
    float largest = max(size.x, max(size.y, size.z));
    float least = uintBitsToFloat(texelFetch(bvh_nodes, textureSize(bvh_nodes) - 1).x);
    return position + normal * max(least, exp2(-20.0) * largest);
}

#endif
