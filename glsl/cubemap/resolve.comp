#version 460
#include "lib/prelude.glsl"
#include "lib/finite.glsl"
#include "lib/mirrored.glsl"

// The light of one texel of a map, W/(m²·sr): what unlit surfaces show, direct light at the surface, and diffuse light and caustics that some methods offer as irradiance E, w·ρ/π·E.

layout(local_size_x = 64) in;

// 1: there is diffuse light.
layout(constant_id = 1) const uint HAS_FIELD = 0u;
// 1: there are caustics.
layout(constant_id = 2) const uint HAS_CAUSTICS = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer seen;        // rays.comp
layout(set = 0, binding = 1) uniform usamplerBuffer points;
layout(set = 0, binding = 2) uniform samplerBuffer light;
layout(set = 0, binding = 3) uniform samplerBuffer irradiance;  // W/m²
layout(set = 0, binding = 4) writeonly buffer Boxes { vec4 boxes[]; };
layout(set = 0, binding = 5) uniform samplerBuffer caustics;    // W/m²

layout(push_constant, scalar) uniform Push { uint texels; } push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.texels) {
        return;
    }
    vec4 shown = texelFetch(seen, int(index));
    vec3 found = texelFetch(light, int(index)).rgb;
    if (HAS_FIELD != 0u || HAS_CAUSTICS != 0u) {
        Mirrored point = load_mirrored(points, index);
        vec3 received = HAS_FIELD != 0u ? texelFetch(irradiance, int(index)).rgb : vec3(0.0);
        received += HAS_CAUSTICS != 0u ? texelFetch(caustics, int(index)).rgb : vec3(0.0);
        found += point.weight * indirect_diffuse_albedo(point.surface) * received * INVERSE_PI;
    }
    boxes[index] = vec4(shown.rgb + (is_finite(found) ? found : vec3(0.0)), shown.w);
}
