// By how much a cache counts for a point of a surface beside its trilinear weight. One that is hidden keeps so little that it stands in only where all others are hidden too.
// (Weights by whether the surface faces the cache, as Majercik et al. 2019 have them, make the error larger once caches lie in front of surfaces: 0.103 in place of 0.095 in
// the corridor.)
#ifndef CACHES_WEIGHTS
#define CACHES_WEIGHTS

#include "lib/cutouts.glsl"
#include "lib/brdf.glsl"
#include "lib/pixel_rays.glsl"
#include "caches/rays.glsl"
#include "lib/bvh.glsl"

const uint WEIGHTS_TRILINEAR = 0u;
const uint WEIGHTS_RAYS = 1u;

layout(constant_id = 2) const uint WEIGHTS = WEIGHTS_TRILINEAR;

const float LEAST_WEIGHT = 1e-4;

// `share`: its trilinear weight. Caches of next to none are not worth a ray.
float weight_of_cache(CacheRays rays, Surface point, vec3 cache_rs, float share) {
    if (WEIGHTS == WEIGHTS_RAYS && share > LEAST_WEIGHT) {
        vec3 normal = point.geometric_normal;
        normal = dot(normal, direction_to_eye(camera, point.position_rs)) < 0.0 ? -normal : normal;
        vec3 origin = pixel_ray_origin(point.position_rs, rays.shift, normal);
        return is_occluded(origin, cache_rs + rays.shift - origin, 1.0) ? LEAST_WEIGHT : 1.0;
    }
    return 1.0;
}

#endif
