#version 460

// One corner of a triangle that covers the flattened image.

#include "vpl/triangle.glsl"
