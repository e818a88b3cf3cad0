// What shines on the scene as rays meet it (lib/emitters.glsl, lib/lights.glsl).
// group: bindings 48 to 55, constants 40 to 43
#ifndef GROUPS_SCENE_LIGHTS
#define GROUPS_SCENE_LIGHTS

// 1: the radiance of some emissive triangles is textured.
layout(constant_id = 40) const uint EMISSIVE_TEXTURES = 1u;
// 1: some emissive surface is cut out by its alpha.
layout(constant_id = 41) const uint EMISSIVE_CUTOUTS = 0u;

layout(set = 0, binding = 48) uniform usamplerBuffer emitters;            // punctual lights and emissive triangles
layout(set = 0, binding = 49) uniform usamplerBuffer emissive_triangles;  // these alone
layout(set = 0, binding = 50) uniform usamplerBuffer punctual_lights;

#endif
