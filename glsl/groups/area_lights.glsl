// Virtual area lights, in groups of neighbours in the light views (src/frame/caches/lights.rs).
// group: bindings 160 to 163
#ifndef GROUPS_AREA_LIGHTS
#define GROUPS_AREA_LIGHTS

layout(set = 0, binding = 160) uniform samplerBuffer area_lights;         // lib/vpl.glsl; the area may be the paper's (caches/reduce.comp)
layout(set = 0, binding = 161) uniform usamplerBuffer area_light_groups;  // caches/light_groups.glsl
layout(set = 0, binding = 162) uniform usamplerBuffer area_light_counts;  // how many lights, how many groups

#endif
