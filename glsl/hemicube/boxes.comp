#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"

// The box around one run of triangles in the order of the hierarchy's leaves, where neighbours lie near each other.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Boxes { vec4 boxes[]; };  // middle | half its size

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint run;  // triangles
} push;

// Over half a box's size: rounding leaves nothing out.
const float SLACK = 1.00001;

void main() {
    uint number = gl_GlobalInvocationID.x;
    uint first = number * push.run;
    if (first >= push.triangle_count) {
        return;
    }
    vec3 low = vec3(3e38);
    vec3 high = vec3(-3e38);
    uint end = 3u * min(first + push.run, push.triangle_count);
    [[dont_unroll]] for (uint corner = 3u * first; corner < end; ++corner) {
        vec3 position = texelFetch(bvh_triangles, int(corner)).xyz;
        low = min(low, position);
        high = max(high, position);
    }
    boxes[2u * number] = vec4(0.5 * (low + high), 0.0);
    boxes[2u * number + 1u] = vec4(0.5 * SLACK * (high - low), 0.0);
}
