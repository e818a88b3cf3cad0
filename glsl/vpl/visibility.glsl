// Visibility of virtual point lights, for vpl/gather.glsl: none asked for, by imperfect shadow maps, or by one ray each.
#ifndef VPL_VISIBILITY
#define VPL_VISIBILITY

#include "groups/surface.glsl"
#include "groups/vpl_visibility.glsl"
#include "ism/lookup.glsl"
#include "lib/pixel_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

bool ray_sees(Vpl vpl, vec3 position_rs, vec3 normal) {
    vec3 origin = pixel_ray_origin(position_rs, vpl_rays.shift, normal);
    vec3 target = lifted_vpl(vpl) + vpl_rays.shift;
    return !is_occluded(origin, target - origin, 1.0);
}

float vpl_visibility(int k, Vpl vpl, vec3 position_rs, vec3 normal) {
    bool sees = true;
    if (VISIBILITY == VISIBILITY_ISM) {
        sees = ism_sees(ism_maps, ISM_RESOLUTION, uint(k), vpl, position_rs, normal);
    } else if (VISIBILITY == VISIBILITY_TRACED) {
        sees = ray_sees(vpl, position_rs, normal);
    }
    return sees ? 1.0 : 0.0;
}

#endif
