#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "lib/vpl.glsl"

// The slot `diffuse` of two pixels: L(x) = ρ/π · E(x) [W/(m²·sr)], E from all virtual point lights (vpl/gather.glsl) at every pixel
// (Quyen 2014, section 3.2.2.2, without the regions), ρ = indirect_diffuse_albedo().

layout(set = 0, binding = 4) uniform samplerBuffer vpls;

#include "vpl/visibility.glsl"
#include "vpl/gather.glsl"
#include "vpl/gather_pixels.glsl"
