// How much of a group of virtual area lights a cache sees.
#ifndef CACHES_VISIBILITY
#define CACHES_VISIBILITY

#include "caches/light_groups.glsl"
#include "lib/vpl.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "caches/rays.glsl"

// 1: by a ray; 0: it sees all.
layout(constant_id = 1) const uint TRACES = 0u;

// `target`: the light that a ray is sent to.
float visibility_of_group(CacheRays rays, LightGroup group, Vpl target, vec3 position_rs) {
    if (TRACES != 0u) {
        vec3 way = lifted_vpl(target) - position_rs;
        return is_occluded(position_rs + rays.shift, way, 1.0) ? 0.0 : 1.0;
    }
    return 1.0;
}

#endif
