#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "lib/vpl.glsl"

// The slot `diffuse` of two pixels: radiance in W/(m²·sr) that x's diffuse lobe scatters of the light from N virtual point
// lights, without visibility (Dachsbacher & Stamminger 2005, eq. 1, in the disc form of lib/vpl.glsl),
//
//   L(x) = ρ/π · E(x)       E(x) = Σ_k Φ_k/π · (n_k·−ω)⁺ (n_x·ω)⁺ / (d² + A_k/π)
//
// with n_x the shading normal and ρ = indirect_diffuse_albedo(). The two pixels are eight columns apart and share the loads of a light.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer vpls;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D diffuse;

layout(push_constant, scalar) uniform Push {
    uint vpl_count;
} push;

struct Receiver {
    vec3 position_rs;
    vec3 normal;
    vec3 response;  // ρ/π; 0 where there is no surface
};

Receiver load_receiver(ivec2 pixel, ivec2 size) {
    float pixel_depth = is_inside(pixel, size) ? texelFetch(depth, pixel, 0).x : 0.0;
    if (pixel_depth <= 0.0) {
        return Receiver(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
    return Receiver(position_rs, point.normal, indirect_diffuse_albedo(point) * INVERSE_PI);
}

void main() {
    ivec2 pixel = pixel_of_invocation(uvec2(16u, 8u));
    ivec2 other = pixel + ivec2(8, 0);
    ivec2 size = imageSize(diffuse);
    Receiver a = load_receiver(pixel, size);
    Receiver b = load_receiver(other, size);
    vec3 irradiance_a = vec3(0.0);
    vec3 irradiance_b = vec3(0.0);
    if (max3(a.response) + max3(b.response) > 0.0) {
        for (int k = 0; k < int(push.vpl_count); ++k) {
            Vpl vpl = unpack_vpl(texelFetch(vpls, 2 * k), texelFetch(vpls, 2 * k + 1));
            irradiance_a += vpl.strength * vpl_form_factor(vpl, a.position_rs, a.normal);
            irradiance_b += vpl.strength * vpl_form_factor(vpl, b.position_rs, b.normal);
        }
    }
    if (is_inside(pixel, size)) {
        imageStore(diffuse, pixel, vec4(irradiance_a * a.response, 1.0));
    }
    if (is_inside(other, size)) {
        imageStore(diffuse, other, vec4(irradiance_b * b.response, 1.0));
    }
}
