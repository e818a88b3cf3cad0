#version 460
#include "lib/prelude.glsl"
#include "particles/link_direction.glsl"

// The cone around one stratum of the hemisphere, whose links go through it: its axis in the frame of the normal, x and y, and cosine and sine of its half angle.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Strata { vec4 strata[]; };

layout(push_constant, scalar) uniform Push { uint side; } push;

// Edges of strata bend: the map is smooth but for the square's diagonals, on which corners of strata lie.
const float BENT = 1.1;

void main() {
    uint link = gl_GlobalInvocationID.x;
    if (link >= push.side * push.side) {
        return;
    }
    vec2 low = vec2(stratum_of_link(link, push.side));
    vec3 axis = cosine_direction((low + 0.5) / float(push.side));
    float least = 1.0;
    for (uint corner = 0u; corner < 4u; ++corner) {
        least = min(least, dot(axis, cosine_direction((low + vec2(corner & 1u, corner >> 1)) / float(push.side))));
    }
    float half_angle = min(BENT * acos(clamp(least, -1.0, 1.0)), 0.5 * PI);
    strata[link] = vec4(axis.xy, cos(half_angle), sin(half_angle));
}
