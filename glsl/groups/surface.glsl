// The first visible surface of each pixel (src/frame/gbuffer.rs), and the camera that sees it.
// group: bindings 56 to 63, constants 44 to 47
#ifndef GROUPS_SURFACE
#define GROUPS_SURFACE

#include "lib/scene.glsl"

// 0: no material has a specular lobe, `specular` is not there.
layout(constant_id = 44) const uint HAS_SPECULAR = 0u;

layout(set = 0, binding = 56) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 57) uniform sampler2D depth;       // reversed; 0: no surface
layout(set = 0, binding = 58) uniform usampler2D surface;    // lib/surface_packing.glsl
layout(set = 0, binding = 59) uniform sampler2D specular;

#endif
