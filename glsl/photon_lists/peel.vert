#version 460
#include "lib/prelude.glsl"
#include "photon_lists/vertex.glsl"

// One vertex of an opaque primitive in a view that layers are peeled from.
