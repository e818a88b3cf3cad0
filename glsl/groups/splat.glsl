// What the passes of photon splatting read of each other's results (src/caustics/photons/splat.rs), and the kernel that they share.
// group: bindings 100 to 107, constants 60 to 63
#ifndef GROUPS_SPLAT
#define GROUPS_SPLAT

layout(constant_id = 60) const uint GAUSSIAN = 0u;
// 1: discs may be ellipses.
layout(constant_id = 61) const uint ELLIPTIC = 0u;

layout(set = 0, binding = 100) uniform usamplerBuffer splat_state;   // photon_splat/state.glsl
layout(set = 0, binding = 101) uniform usamplerBuffer splat_tiles;   // one of the two lists of tiles
layout(set = 0, binding = 102) uniform usamplerBuffer splat_peaks;   // the brightest disc of each tile, W/m², as a float's bits
layout(set = 0, binding = 103) uniform usamplerBuffer splat_levels;  // photon_splat/levels.glsl

#endif
