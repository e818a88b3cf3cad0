// Points of surfaces that mirrors and glass show (src/frame/mirrored.rs).
// group: bindings 144 to 147
#ifndef GROUPS_MIRRORED
#define GROUPS_MIRRORED

layout(set = 0, binding = 144) uniform usamplerBuffer mirrored_points;  // lib/mirrored.glsl
layout(set = 0, binding = 145) uniform usamplerBuffer mirrored_count;   // word 3: how many there are

#endif
