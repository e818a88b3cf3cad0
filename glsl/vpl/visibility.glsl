// Visibility of virtual point lights, for vpl/gather.glsl: none asked for, by imperfect shadow maps, or by one ray each.
#ifndef VPL_VISIBILITY
#define VPL_VISIBILITY

#include "groups/surface.glsl"
#include "groups/vpl_visibility.glsl"
#include "ism/lookup.glsl"
#include "lib/ray_offset.glsl"
#include "path/cutouts.glsl"
#include "lib/bvh.glsl"

// A position from the depth buffer is off its surface by a few units in the last place of its distance from the camera.
const float DEPTH_SLACK = 1.0 / 131072.0;

bool ray_sees(Vpl vpl, vec3 position_rs, vec3 normal) {
    float away = camera.depth_range > 0.0 ? camera.depth_range : distance(camera.position_rs, position_rs);
    vec3 origin = offset_ray_origin(position_rs + vpl_rays.shift, normal) + normal * (DEPTH_SLACK * away);
    vec3 target = vpl.position_rs + vpl_rays.shift + normalize(vpl.normal) * vpl_rays.offset;
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
