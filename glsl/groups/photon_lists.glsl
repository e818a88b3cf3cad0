// The scene as lists of the surfaces behind each texel of a few views (photon_lists/node.glsl, photon_lists/view.glsl).
// group: bindings 108 to 111
#ifndef GROUPS_PHOTON_LISTS
#define GROUPS_PHOTON_LISTS

layout(set = 0, binding = 108) uniform samplerBuffer list_views;
layout(set = 0, binding = 109) uniform usamplerBuffer list_pixels;
layout(set = 0, binding = 110) uniform usamplerBuffer list_nodes;

#endif
