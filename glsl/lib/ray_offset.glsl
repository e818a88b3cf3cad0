// Rays that start on a surface.
#ifndef LIB_RAY_OFFSET
#define LIB_RAY_OFFSET

#include "groups/scene_rays.glsl"

// Moves a point of a surface, computed from its triangle's corners, to the side that the normal points to, so far that rays from
// there do not meet the surface again: 256 units in the last place (Wächter & Binder, Ray Tracing Gems, ch. 6). Their constants
// for points near the origin are replaced by a share of the scene's extent, so that no unit of length matters.
vec3 offset_ray_origin(vec3 position, vec3 normal) {
    uint exponents = texelFetch(bvh_nodes, 0).w;
    uvec3 axes = uvec3(exponents, exponents >> 8, exponents >> 16) & 255u;
    // A step of the root's grid is 1/255 to 1/128 of the extent.
    float step = uintBitsToFloat(max(axes.x, max(axes.y, axes.z)) << 23);
    vec3 size = abs(position);
    return position + normal * (exp2(-16.0) * max(8.0 * step, max(size.x, max(size.y, size.z))));
}

#endif
