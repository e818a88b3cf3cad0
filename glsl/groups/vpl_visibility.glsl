// What decides whether light from a virtual point light may be blocked (vpl/visibility.glsl).
// group: bindings 96 to 99, constants 56 to 59
#ifndef GROUPS_VPL_VISIBILITY
#define GROUPS_VPL_VISIBILITY

#include "vpl/rays.glsl"

const uint VISIBILITY_NONE = 0u;
const uint VISIBILITY_ISM = 1u;
const uint VISIBILITY_TRACED = 2u;

layout(constant_id = 56) const uint VISIBILITY = VISIBILITY_NONE;
layout(constant_id = 57) const uint ISM_RESOLUTION = 32u;

layout(set = 0, binding = 96) uniform samplerBuffer ism_maps;
layout(set = 0, binding = 97) uniform VplRaysBlock { VplRays vpl_rays; };

#endif
