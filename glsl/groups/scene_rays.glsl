// The scene as rays meet it (src/frame/rays/traced_scene.rs), and the points that rays are drawn by.
// group: bindings 32 to 47, constants 32 to 39
#ifndef GROUPS_SCENE_RAYS
#define GROUPS_SCENE_RAYS

#include "lib/scene.glsl"

// 1: some surface is cut out by its alpha; some mesh has vertex colors; some surface has a normal map and the tangents to use it.
layout(constant_id = 32) const uint ALPHA_MASKS = 0u;
layout(constant_id = 33) const uint VERTEX_COLORS = 0u;
layout(constant_id = 34) const uint NORMAL_MAPS = 0u;
// The MATERIAL_ bits of the texture kinds that any material has.
layout(constant_id = 35) const uint TEXTURES = 0u;
// 1: points of some emissive triangles are drawn cell by cell (lib/emissive_cells.glsl).
layout(constant_id = 36) const uint EMISSIVE_CELLS = 0u;

// 1: triangles are so much smaller than the largest coordinates that rounding is bounded triangle by triangle (lib/bvh.glsl); 0: by the scene's extent.
layout(constant_id = 37) const uint WIDE = 0u;

layout(set = 0, binding = 32) uniform usamplerBuffer bvh_nodes;          // lib/bvh.glsl
layout(set = 0, binding = 33) uniform samplerBuffer bvh_triangles;
layout(set = 0, binding = 34) uniform usamplerBuffer triangles;          // lib/traced_scene.glsl
layout(set = 0, binding = 35) uniform samplerBuffer corner_colors;       // rgba8 unorm
layout(set = 0, binding = 36) uniform samplerBuffer corner_texcoords;    // rgba32f: sets 0 and 1
layout(set = 0, binding = 37) uniform samplerBuffer corner_tangents;     // rgba32f
layout(set = 0, binding = 38) uniform usamplerBuffer materials;          // lib/scene.glsl
layout(set = 0, binding = 39) uniform samplerBuffer media;               // rgba32f: absorption in 1/m, 1 where the surface bounds a medium
layout(set = 0, binding = 40) uniform usamplerBuffer material_textures;
layout(set = 0, binding = 41) uniform usamplerBuffer texture_table;      // lib/texels.glsl
layout(set = 0, binding = 42) uniform samplerBuffer texels;
layout(set = 0, binding = 43) uniform usamplerBuffer sobol;              // lib/sobol.glsl

#endif
