#version 460
#include "lib/prelude.glsl"

// A fragment inside a rectangle of pixels marks the stencil; there is no colour.

layout(push_constant, scalar) uniform Push {
    vec2 low;
    vec2 high;
} push;

void main() {
    if (any(lessThan(gl_FragCoord.xy, push.low)) || any(greaterThanEqual(gl_FragCoord.xy, push.high))) {
        discard;
    }
}
