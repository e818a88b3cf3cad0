// The scene as passes draw it (src/frame/geometry.rs). A draw of instance i has its first instance set to i.
// group: bindings 72 to 79
#ifndef GROUPS_GEOMETRY
#define GROUPS_GEOMETRY

#include "lib/scene.glsl"

layout(set = 0, binding = 72) uniform usamplerBuffer instances;       // lib/scene.glsl
layout(set = 0, binding = 73) uniform usamplerBuffer indices;         // r32ui
layout(set = 0, binding = 74) uniform samplerBuffer positions;        // r32f, three a vertex
layout(set = 0, binding = 75) uniform usamplerBuffer drawn_materials;
layout(set = 0, binding = 76) uniform usamplerBuffer drawn_textures;  // how materials read textures

#endif
