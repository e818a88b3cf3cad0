// Paths on their way, as kernels read them (path/state.glsl, path/vertex.glsl), and what all kernels of a walk are compiled for.
// group: bindings 80 to 87, constants 48 to 55
#ifndef GROUPS_PATHS
#define GROUPS_PATHS

// 1: paths from lights.
layout(constant_id = 48) const uint FROM_LIGHT = 0u;
// 1: lights send out paths of their own, so that camera paths carry the ratio C of path/mis.glsl.
layout(constant_id = 49) const uint LIGHT_PATHS = 1u;
// What a camera's path leaves to photons behind its first diffuse vertex (path/state.glsl).
layout(constant_id = 50) const uint PHOTONS = 0u;
// 1: light that some diffuse lobe scattered on its way is left out of the slot `caustics`.
layout(constant_id = 51) const uint SPECULAR_CAUSTICS = 0u;
// Unlike 0: lamps behind the first surface's glass and unlit surfaces in mirrors are in the slot `specular`, not in the slot `direct`, as rays that follow reflections
// find them.
layout(constant_id = 52) const uint FOLLOWED = 0u;
// The slot `specular` leaves out caustics in what mirrors and glass show.
const uint FOLLOWED_UNMIRRORED = 1u;
// Reflections and refractions at most between the eye and what mirrors and glass show; 0: there is no such limit.
layout(constant_id = 53) const uint MIRRORS = 0u;
// Where there is one, scatterings at most between the light and that.
layout(constant_id = 54) const uint BOUNCES = 0xFFFFFFFFu;
// 1: between the lights and the first visible surface light scatters diffusely alone.
layout(constant_id = 55) const uint DIFFUSE_ALONE = 0u;

layout(set = 0, binding = 80) uniform samplerBuffer path_rays;
layout(set = 0, binding = 81) uniform samplerBuffer path_states;
layout(set = 0, binding = 82) uniform usamplerBuffer path_flags;
layout(set = 0, binding = 83) uniform usamplerBuffer path_seeds;
layout(set = 0, binding = 84) uniform usamplerBuffer path_vertices;
layout(set = 0, binding = 85) uniform usamplerBuffer active_paths;  // on their way to the vertex
layout(set = 0, binding = 86) uniform usamplerBuffer alive_paths;   // that go on from there

#endif
