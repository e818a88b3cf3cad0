// A point of a surface that reflects or transmits specularly, as photons need it. In the light views it is two texels (rgba32ui, rg32ui):
//
//   shading normal | geometric normal | √f0 | √transmission     normals: packed directions, on the light's side; colors: 11, 11, 10 bits
//   f90, roughness (unorm16 each) | material and SURFACE_FRONT
//
// The square root keeps the steps small where colors are: 0.04 is 0.5 % off at most.
#ifndef PHOTONS_SURFACE_TEXEL
#define PHOTONS_SURFACE_TEXEL

#include "lib/octahedral.glsl"

const uint SURFACE_FRONT = 0x80000000u;

const vec3 ROOT_STEPS = vec3(2047.0, 2047.0, 1023.0);

uint pack_root_color(vec3 color) {
    uvec3 root = uvec3(round(sqrt(clamp(color, 0.0, 1.0)) * ROOT_STEPS));
    return root.x | root.y << 11 | root.z << 22;
}

vec3 unpack_root_color(uint bits) {
    vec3 root = vec3(bits & 0x7FFu, bits >> 11 & 0x7FFu, bits >> 22) / ROOT_STEPS;
    return root * root;
}

#endif
