#version 460
#include "lib/prelude.glsl"
#include "gbuffer/numbered_vertex.glsl"
