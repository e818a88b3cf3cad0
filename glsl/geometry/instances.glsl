// Set 0 of every program that draws the scene: what the vertex and the fragment stage know of an instance.
// A draw of instance i has its first instance set to i.
#ifndef GEOMETRY_INSTANCES
#define GEOMETRY_INSTANCES

#include "lib/scene.glsl"

layout(set = 0, binding = 0) uniform usamplerBuffer instances;

#endif
