#version 460
#include "lib/prelude.glsl"

// One corner of a triangle that lies flat a metre below the eye and reaches as far as it says before it, beside it and behind it.

layout(push_constant, scalar) uniform Push {
    float reach;
    float side;  // 1 or -1: which way round
    uint width;
} push;

void main() {
    // Right and forward, of one before the eye and two behind.
    vec2 corner = vec2(push.side * float(gl_VertexIndex - 1), gl_VertexIndex == 1 ? 1.0 : -1.0) * push.reach;
    gl_Position = vec4(corner.x, 1.0, 0.01, corner.y);
}
