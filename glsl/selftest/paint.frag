#version 460
#include "lib/prelude.glsl"

// One colour all over.

layout(location = 0) out vec4 painted;

layout(push_constant, scalar) uniform Push { vec4 color; } push;

void main() {
    painted = push.color;
}
