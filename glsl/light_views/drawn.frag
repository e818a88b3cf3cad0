#version 460
#include "lib/prelude.glsl"

// One texel of a light view: which triangle it shows (geometry/drawn_triangle.glsl).

layout(location = 2) flat in uvec2 drawn;

layout(location = 0) out uvec2 triangle;  // rg32ui

void main() {
    triangle = drawn;
}
