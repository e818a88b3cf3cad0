// The lights and what they see (src/frame/light_views.rs).
// group: bindings 64 to 71
#ifndef GROUPS_LIGHT_VIEWS
#define GROUPS_LIGHT_VIEWS

layout(set = 0, binding = 64) uniform usamplerBuffer lights;      // lib/lights.glsl
layout(set = 0, binding = 65) uniform usamplerBuffer views;
layout(set = 0, binding = 66) uniform sampler2D light_depth;      // reversed, each view in its rectangle
// Of reflective views alone.
layout(set = 0, binding = 67) uniform usampler2D light_normal;    // packed directions
layout(set = 0, binding = 68) uniform sampler2D light_flux;       // over the view's flux scale

#endif
