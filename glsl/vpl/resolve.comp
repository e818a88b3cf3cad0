#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "vpl/regions.glsl"

// The slot `diffuse` of 2x2 pixels: L = ρ/π · E [W/(m²·sr)], ρ = indirect_diffuse_albedo(). If they are one flat region, E comes from the
// regions of their size (vpl/upsample.glsl), else it is what was gathered at each pixel.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D surface;
layout(set = 0, binding = 2) uniform sampler2D specular;
layout(set = 0, binding = 3) uniform sampler2D region_planes;
layout(set = 0, binding = 4) uniform sampler2D irradiance;
layout(set = 0, binding = 5, rgba32f) writeonly uniform image2D diffuse;
layout(set = 0, binding = 6) uniform CameraBlock { Camera camera; };

layout(push_constant, scalar) uniform Push {
    float depth_threshold;
    float normal_threshold;
    uint has_specular;  // 0: no material has a specular lobe, `specular` is not read
} push;

vec4 irradiance_at(ivec2 texel) {
    return texelFetch(irradiance, texel, 0);
}

float depth_of_square(ivec2 cell) {
    return texelFetch(depth, cell, 0).x;
}

#include "vpl/upsample.glsl"

void main() {
    ivec2 region = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (any(greaterThanEqual(2 * region, size))) {
        return;
    }
    vec4 plane = is_inside(region, size / 2) ? texelFetch(region_planes, region, 0) : vec4(0.0);
    Quarters quarters;
    if (plane.x > 0.0) {
        quarters = upsampled(Upsampling(size, 0, push.depth_threshold, unit_of_depth(camera), push.normal_threshold), region, plane);
    } else {
        for (int i = 0; i < 4; ++i) {
            ivec2 pixel = 2 * region + ivec2(i & 1, i >> 1);
            quarters.irradiance[i] = is_inside(pixel, size) ? irradiance_at(pixel).rgb : vec3(0.0);
        }
    }
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = 2 * region + ivec2(i & 1, i >> 1);
        if (is_inside(pixel, size)) {
            vec4 lobe = push.has_specular != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
            Surface point = unpack_surface(vec3(0.0), texelFetch(surface, pixel, 0), lobe);
            imageStore(diffuse, pixel, vec4(quarters.irradiance[i] * (indirect_diffuse_albedo(point) * INVERSE_PI), 1.0));
        }
    }
}
