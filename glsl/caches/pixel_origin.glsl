// Where rays from a pixel's surface to the caches around it start.
#ifndef CACHES_PIXEL_ORIGIN
#define CACHES_PIXEL_ORIGIN

#include "caches/rays.glsl"
#include "lib/brdf.glsl"
#include "lib/pixel_rays.glsl"

// In the space of rays, on the side of the surface that the eye sees.
vec3 origin_of_pixel(Surface point, CacheRays rays) {
    vec3 normal = point.geometric_normal;
    normal = dot(normal, direction_to_eye(camera, point.position_rs)) < 0.0 ? -normal : normal;
    return pixel_ray_origin(point.position_rs, rays.shift, normal);
}

#endif
