// Light maps of all surfaces (src/frame/rays/lightmap/): how they lie on triangles, and their texels (lightmaps/texels.glsl).
// group: bindings 184 to 191
#ifndef GROUPS_LIGHTMAP
#define GROUPS_LIGHTMAP

layout(set = 0, binding = 184) uniform usamplerBuffer lightmap_charts;  // by triangle (lightmaps/charts.glsl)
layout(set = 0, binding = 185) uniform usamplerBuffer lightmap_texels;  // by number (lightmaps/texels.glsl)
layout(set = 0, binding = 186) uniform usamplerBuffer lightmap_flags;   // r32ui, by number

#endif
