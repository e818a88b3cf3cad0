#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"

// The nearest hit of each ray of a list.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer rays;  // origin, t_max; direction, unused

#include "lib/bvh.glsl"

layout(set = 0, binding = 1) writeonly buffer Hits { Hit hits[]; };

void main() {
    int ray = int(gl_GlobalInvocationID.x);
    if (2 * ray >= textureSize(rays)) {
        return;
    }
    vec4 origin = texelFetch(rays, 2 * ray);
    hits[ray] = closest_hit(origin.xyz, texelFetch(rays, 2 * ray + 1).xyz, origin.w);
}
