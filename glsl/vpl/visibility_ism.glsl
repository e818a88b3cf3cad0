// Visibility of virtual point lights by their imperfect shadow maps, for vpl/gather.glsl.

#include "ism/lookup.glsl"

layout(constant_id = 0) const uint ISM_RESOLUTION = 32u;

layout(set = 0, binding = 6) uniform samplerBuffer ism_maps;

#define VPL_VISIBILITY

float vpl_visibility(int k, Vpl vpl, vec3 position_rs, vec3 normal) {
    return ism_sees(ism_maps, ISM_RESOLUTION, uint(k), vpl, position_rs, normal) ? 1.0 : 0.0;
}
