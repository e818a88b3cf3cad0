#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "hemicube/seen.glsl"

// Lists what one view may see, view by view and run by run whatever the device does, so that surfaces in one place are drawn in one order; the first one also says
// how much that is to draw.

layout(local_size_x = 64) in;

layout(set = 0, binding = 3) uniform usamplerBuffer starts;                 // of each view in the list
layout(set = 0, binding = 4) writeonly buffer Pairs { uint pairs[]; };      // view in the upper half, run in the lower
layout(set = 0, binding = 5) writeonly buffer Arguments { uint arguments[]; };  // of the draw

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number == 0u) {
        arguments[0] = 3u * push.run;
        arguments[1] = texelFetch(starts, int(push.view_count)).x;
        arguments[2] = 0u;
        arguments[3] = 0u;
    }
    if (!is_view(number)) {
        return;
    }
    uint place = texelFetch(starts, int(number)).x;
    View view = view_of_texel(texelFetch(list, int(push.first + number)).x);
    [[dont_unroll]] for (uint run = 0u; run < push.run_count; ++run) {
        if (sees_run(view, run)) {
            pairs[place] = number << 16 | run;
            ++place;
        }
    }
}
