#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "lib/vpl.glsl"
#include "vpl/visibility_traced.glsl"

// The slot `diffuse` of two pixels, as gather_pixels.comp, with a ray to each VPL that would give light.

layout(set = 0, binding = 4) uniform samplerBuffer vpls;

#include "vpl/gather.glsl"
#include "vpl/gather_pixels.glsl"
