#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "lib/vpl.glsl"

// The slot `diffuse` of two pixels, eight columns apart, which share the loads of a light: L(x) = ρ/π · E(x) [W/(m²·sr)], E from all virtual
// point lights (vpl/gather.glsl) at every pixel (Quyen 2014, section 3.2.2.2, without the regions), ρ = indirect_diffuse_albedo().

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer vpls;
layout(set = 0, binding = 1, rgba32f) uniform image2D diffuse;

#include "vpl/gather.glsl"

layout(push_constant, scalar) uniform Push {
    VplRange range;
} push;

Receiver load_receiver(ivec2 pixel, ivec2 size, out vec3 response) {
    response = vec3(0.0);
    float pixel_depth = is_inside(pixel, size) ? texelFetch(depth, pixel, 0).x : 0.0;
    if (pixel_depth <= 0.0) {
        return Receiver(vec3(0.0), vec3(0.0));
    }
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
    response = indirect_diffuse_albedo(point) * INVERSE_PI;
    return Receiver(position_rs, point.normal);
}

void store_sum(ivec2 pixel, vec3 radiance) {
    imageStore(diffuse, pixel, vec4(imageLoad(diffuse, pixel).rgb + radiance, 1.0));
}

void main() {
    ivec2 pixel = pixel_of_invocation(uvec2(16u, 8u));
    ivec2 other = pixel + ivec2(8, 0);
    ivec2 size = imageSize(diffuse);
    vec3 response_a;
    vec3 response_b;
    Receiver a = load_receiver(pixel, size, response_a);
    Receiver b = load_receiver(other, size, response_b);
    vec3 irradiance_a = vec3(0.0);
    vec3 irradiance_b = vec3(0.0);
    if (max3(response_a) + max3(response_b) > 0.0) {
        gather(push.range, a, b, irradiance_a, irradiance_b);
    }
    if (is_inside(pixel, size)) {
        store_sum(pixel, irradiance_a * response_a);
    }
    if (is_inside(other, size)) {
        store_sum(other, irradiance_b * response_b);
    }
}
