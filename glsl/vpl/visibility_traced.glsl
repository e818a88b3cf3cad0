// Visibility of virtual point lights by one ray each, for vpl/gather.glsl. Bindings 6 to 9 and 16 to 22.

#include "vpl/rays.glsl"

layout(set = 0, binding = 6) uniform usamplerBuffer bvh_nodes;
layout(set = 0, binding = 7) uniform samplerBuffer bvh_triangles;
layout(set = 0, binding = 8) uniform RaysBlock { VplRays rays; };
layout(set = 0, binding = 9) uniform EyeBlock { Camera eye; };

#include "lib/ray_offset.glsl"
#include "path/cutouts.glsl"
#include "lib/bvh.glsl"

#define VPL_VISIBILITY

// A position from the depth buffer is off its surface by a few units in the last place of its distance from the eye.
const float DEPTH_SLACK = 1.0 / 131072.0;

float vpl_visibility(int k, Vpl vpl, vec3 position_rs, vec3 normal) {
    float away = eye.depth_range > 0.0 ? eye.depth_range : distance(eye.position_rs, position_rs);
    vec3 origin = offset_ray_origin(position_rs + rays.shift, normal) + normal * (DEPTH_SLACK * away);
    vec3 target = vpl.position_rs + rays.shift + normalize(vpl.normal) * rays.offset;
    return is_occluded(origin, target - origin, 1.0) ? 0.0 : 1.0;
}
