// How much of a group of virtual area lights a cache sees.
#ifndef VOLUMES_VISIBILITY
#define VOLUMES_VISIBILITY

#include "caches/light_groups.glsl"
#include "lib/vpl.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "volumes/rays.glsl"

const uint VISIBILITY_NONE = 0u;
const uint VISIBILITY_RAYS = 1u;

layout(constant_id = 1) const uint VISIBILITY = VISIBILITY_NONE;

// `middle`: the light that a ray is sent to.
float visibility_of_group(VolumeRays rays, LightGroup group, Vpl middle, vec3 position_rs) {
    if (VISIBILITY == VISIBILITY_RAYS) {
        vec3 way = lifted_vpl(middle) - position_rs;
        return is_occluded(position_rs + rays.shift, way, 1.0) ? 0.0 : 1.0;
    }
    return 1.0;
}

#endif
