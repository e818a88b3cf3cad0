// Set 0 and push constants of the program that draws photon rays as lines over the texels of one view.
#ifndef PHOTON_LISTS_LINE
#define PHOTON_LISTS_LINE

#include "groups/photon_lists.glsl"
#include "photon_lists/hit.glsl"

layout(set = 0, binding = 0) uniform usamplerBuffer rays;

layout(push_constant, scalar) uniform Push {
    uint view_index;
    uint resolution;
} push;

#endif
