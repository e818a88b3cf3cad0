#version 460
#include "lib/prelude.glsl"
#include "photon_lists/vertex_masked.glsl"

// One vertex of an alpha-masked primitive in a view that per-pixel lists are drawn from.
