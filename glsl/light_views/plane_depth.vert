#version 460
#include "lib/prelude.glsl"
#include "light_views/numbered_vertex.glsl"
