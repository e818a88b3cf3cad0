#version 460

// One corner of a triangle that covers the whole area.

#include "selftest/triangle.glsl"
