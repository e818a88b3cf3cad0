// How much of a group of virtual area lights a cache sees: a cone from the cache around all of them.
#ifndef CACHES_CONE_VISIBILITY
#define CACHES_CONE_VISIBILITY

#include "caches/light_groups.glsl"
#include "lib/voxel_cones.glsl"
#include "lib/vpl.glsl"
#include "caches/rays.glsl"

float visibility_of_group(CacheRays rays, LightGroup group, Vpl target, vec3 position_rs) {
    return cone_visibility(position_rs, group.center_rs, group.radius, target.normal);
}

#endif
