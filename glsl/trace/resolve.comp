#version 460
#include "lib/prelude.glsl"
#include "lib/finite.glsl"
#include "lib/mirrored.glsl"
#include "lib/pixels.glsl"
#include "lib/vectors.glsl"

// The slot `specular` of one pixel: what shines by itself on its ways, and the light of all surfaces that they come to, always in the same order. Diffuse light
// and caustics come as irradiance E, if some method offers them, and are reflected by each point's own albedo: w·ρ/π·E.

layout(local_size_x = 64) in;

// 1: there is diffuse light.
layout(constant_id = 0) const uint HAS_FIELD = 0u;
// 1: there are caustics.
layout(constant_id = 1) const uint HAS_CAUSTICS = 0u;

layout(set = 0, binding = 0) uniform usampler2D heads;
layout(set = 0, binding = 1) uniform sampler2D shining;
layout(set = 0, binding = 2) uniform usamplerBuffer points;
layout(set = 0, binding = 3) uniform samplerBuffer light;
layout(set = 0, binding = 4) uniform samplerBuffer irradiance;  // W/m²
layout(set = 0, binding = 5, rgba32f) writeonly uniform image2D specular;
layout(set = 0, binding = 6) uniform samplerBuffer caustics;    // W/m²

layout(push_constant, scalar) uniform Push { uint first_row; } push;

void main() {
    ivec2 pixel = pixel_of_invocation() + ivec2(0, push.first_row);
    if (!is_inside(pixel, imageSize(specular))) {
        return;
    }
    vec3 radiance = texelFetch(shining, pixel, 0).rgb;
    uint next = texelFetch(heads, pixel, 0).x;
    [[dont_unroll]] while (next != 0u) {
        uint index = next - 1u;
        vec3 found = texelFetch(light, int(index)).rgb;
        if (HAS_FIELD != 0u || HAS_CAUSTICS != 0u) {
            Mirrored point = load_mirrored(points, index);
            vec3 received = HAS_FIELD != 0u ? texelFetch(irradiance, int(index)).rgb : vec3(0.0);
            received += HAS_CAUSTICS != 0u ? texelFetch(caustics, int(index)).rgb : vec3(0.0);
            found += point.weight * indirect_diffuse_albedo(point.surface) * received * INVERSE_PI;
        }
        radiance += is_finite(found) ? found : vec3(0.0);
        next = texelFetch(points, 4 * int(index)).w;
    }
    imageStore(specular, pixel, vec4(radiance, 1.0));
}
