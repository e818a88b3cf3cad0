// Rays between paths and lights or the camera, and the light that they carry where nothing is in their way (path/state.glsl).
// group: bindings 124 to 127
#ifndef GROUPS_CONNECTIONS
#define GROUPS_CONNECTIONS

layout(set = 0, binding = 124) uniform usamplerBuffer connections;  // path/queue.glsl
layout(set = 0, binding = 125) uniform samplerBuffer connection_rays;
layout(set = 0, binding = 126) uniform samplerBuffer connection_light;

#endif
