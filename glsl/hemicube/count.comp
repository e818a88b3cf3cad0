#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "hemicube/seen.glsl"

// How many runs of triangles one view may see.

layout(local_size_x = 64) in;

layout(set = 0, binding = 3) writeonly buffer Counts { uint counts[]; };

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.view_count) {
        return;
    }
    uint count = 0u;
    if (is_view(number)) {
        View view = view_of_texel(texelFetch(list, int(push.first + number)).x);
        [[dont_unroll]] for (uint run = 0u; run < push.run_count; ++run) {
            count += sees_run(view, run) ? 1u : 0u;
        }
    }
    counts[number] = count;
}
