#version 460
#include "lib/prelude.glsl"
#include "lib/surface_packing.glsl"
#include "lib/vpl.glsl"
#include "vpl/region_planes.glsl"
#include "vpl/regions.glsl"

// Irradiance E [W/m²] of one region whose stencil is marked: the sum over all VPLs at the region's receiver (vpl/gather.glsl). The alpha of
// what it writes is the receiver's normal, packed, which is above 0.

layout(set = 0, binding = 5) uniform samplerBuffer vpls;

#include "vpl/visibility.glsl"
#include "vpl/gather.glsl"
#include "vpl/receivers.glsl"
#include "vpl/gather_stencil.glsl"
