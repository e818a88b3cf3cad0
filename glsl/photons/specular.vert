#version 460
#include "lib/prelude.glsl"
#include "light_views/vertex.glsl"

// One vertex of a primitive without textures that has a specular lobe, drawn over a light view's depth: the same place to the bit.
