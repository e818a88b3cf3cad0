// What the G-buffer holds of the first visible surface. See lib/surface_packing.glsl for the texels. Depth is an attachment too, and the
// only mark of a pixel without a surface (0). A target that nobody reads is not attached, and what is written to it goes nowhere.

#include "lib/surface_packing.glsl"

layout(location = 0) out uvec4 surface;   // rgba32ui
layout(location = 1) out vec4 specular;   // rgba16f
layout(location = 2) out vec4 emission;   // rgba32f: radiance, W/(m²·sr); cleared to the sky's
