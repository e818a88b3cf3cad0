// Visibility of virtual point lights, for vpl/gather.glsl: none asked for, by imperfect shadow maps, or by one ray each. Bindings 8 to 12 and
// 16 to 22; what a kernel does not use, something else may stand for.
#ifndef VPL_VISIBILITY
#define VPL_VISIBILITY

#include "vpl/rays.glsl"

const uint VISIBILITY_NONE = 0u;
const uint VISIBILITY_ISM = 1u;
const uint VISIBILITY_TRACED = 2u;

layout(constant_id = 0) const uint VISIBILITY = VISIBILITY_NONE;
layout(constant_id = 1) const uint ISM_RESOLUTION = 32u;

layout(set = 0, binding = 8) uniform samplerBuffer ism_maps;
layout(set = 0, binding = 9) uniform usamplerBuffer bvh_nodes;
layout(set = 0, binding = 10) uniform samplerBuffer bvh_triangles;
layout(set = 0, binding = 11) uniform RaysBlock { VplRays rays; };
layout(set = 0, binding = 12) uniform EyeBlock { Camera eye; };

#include "ism/lookup.glsl"
#include "lib/ray_offset.glsl"
#include "path/cutouts.glsl"
#include "lib/bvh.glsl"

// A position from the depth buffer is off its surface by a few units in the last place of its distance from the eye.
const float DEPTH_SLACK = 1.0 / 131072.0;

bool ray_sees(Vpl vpl, vec3 position_rs, vec3 normal) {
    float away = eye.depth_range > 0.0 ? eye.depth_range : distance(eye.position_rs, position_rs);
    vec3 origin = offset_ray_origin(position_rs + rays.shift, normal) + normal * (DEPTH_SLACK * away);
    vec3 target = vpl.position_rs + rays.shift + normalize(vpl.normal) * rays.offset;
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
