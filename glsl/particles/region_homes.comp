#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "particles/region_point.glsl"

// The particle that stands for one region of the picture (seen_home.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 2) writeonly buffer Homes { uint homes[]; };
layout(set = 0, binding = 3) buffer Marks { uint marks[]; };

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    ivec2 size;       // pixels
    int level_count;
} push;

#include "particles/seen_home.glsl"

void main() {
    uint index = region_of_invocation();
    RegionPoint point = region_point(index, push.size, push.level_count);
    if (point.texel.x < 0) {
        return;
    }
    vec3 to_eye = direction_to_eye(camera, point.position_rs);
    homes[index] = seen_home(point.position_rs + push.shift, point.geometric_normal, to_eye, 3e38);
}
