// Paths as the kernels that start them or send them on leave them (path/state.glsl).
// group: bindings 88 to 95
#ifndef GROUPS_NEW_PATHS
#define GROUPS_NEW_PATHS

layout(set = 0, binding = 88) buffer NewRayBlock { vec4 new_rays[]; };
layout(set = 0, binding = 89) buffer NewStateBlock { vec4 new_states[]; };
layout(set = 0, binding = 90) buffer NewFlagBlock { uint new_flags[]; };
layout(set = 0, binding = 91) buffer NewSeedBlock { uvec2 new_seeds[]; };
layout(set = 0, binding = 92) buffer NewQueueBlock { uint new_paths[]; };

#endif
