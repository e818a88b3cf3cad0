#version 460
#include "lib/prelude.glsl"

// What a cube shows along the six axes: +x, -x, +y, -y, +z, -z.

layout(local_size_x = 6) in;

layout(set = 0, binding = 0) uniform samplerCube cube;
layout(set = 0, binding = 1) writeonly buffer Seen { vec4 seen[]; };

void main() {
    uint face = gl_LocalInvocationIndex;
    vec3 axis = vec3(face / 2u == 0u, face / 2u == 1u, face / 2u == 2u) * ((face & 1u) == 0u ? 1.0 : -1.0);
    seen[face] = textureLod(cube, axis, 0.0);
}
