// Triangles that light paths are sent to (src/frame/rays/targets.rs).
// group: bindings 132 to 135
#ifndef GROUPS_LIGHT_TARGETS
#define GROUPS_LIGHT_TARGETS

layout(set = 0, binding = 132) uniform usamplerBuffer targets;            // a table as that of lights (lib/emitters.glsl)
layout(set = 0, binding = 133) uniform samplerBuffer target_densities;    // of every triangle of the scene, r32f (path/mis.glsl)

#endif
