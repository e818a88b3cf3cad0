#version 460
#include "lib/prelude.glsl"
#include "light_views/vertex.glsl"

// One vertex of a primitive without textures in a reflective light view.
