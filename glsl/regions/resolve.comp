#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "regions/regions.glsl"

// The slot `diffuse` of 2x2 pixels: L = ρ/π · E [W/(m²·sr)], ρ = indirect_diffuse_albedo(). If they are one flat region, E comes from the
// regions of their size (regions/upsample.glsl), else it is what was gathered at each pixel.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D region_planes;
layout(set = 0, binding = 1) uniform sampler2D irradiance;
layout(set = 0, binding = 2, rgba32f) writeonly uniform image2D diffuse;

layout(push_constant, scalar) uniform Push {
    float depth_threshold;
    float normal_threshold;
} push;

vec4 irradiance_at(ivec2 texel) {
    return texelFetch(irradiance, texel, 0);
}

float depth_of_square(ivec2 cell) {
    return texelFetch(depth, cell, 0).x;
}

#include "regions/upsample.glsl"

vec3 gathered_at(ivec2 pixel, ivec2 size) {
    return is_inside(pixel, size) ? irradiance_at(pixel).rgb : vec3(0.0);
}

void store(ivec2 pixel, ivec2 size, vec3 received) {
    if (is_inside(pixel, size)) {
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(vec3(0.0), texelFetch(surface, pixel, 0), lobe);
        imageStore(diffuse, pixel, vec4(received * (indirect_diffuse_albedo(point) * INVERSE_PI), 1.0));
    }
}

void main() {
    ivec2 region = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    ivec2 pixel = 2 * region;
    if (!is_inside(pixel, size)) {
        return;
    }
    vec4 plane = is_inside(region, size / 2) ? texelFetch(region_planes, region, 0) : vec4(0.0);
    Quarters quarters;
    if (plane.x > 0.0) {
        Upsampling by = Upsampling(size, 0, push.depth_threshold, unit_of_depth(camera), push.normal_threshold);
        quarters = upsampled(by, region, plane);
    } else {
        quarters = Quarters(
            gathered_at(pixel, size), gathered_at(pixel + ivec2(1, 0), size), gathered_at(pixel + ivec2(0, 1), size),
            gathered_at(pixel + ivec2(1, 1), size), 0.0);
    }
    store(pixel, size, quarters.upper_left);
    store(pixel + ivec2(1, 0), size, quarters.upper_right);
    store(pixel + ivec2(0, 1), size, quarters.lower_left);
    store(pixel + ivec2(1, 1), size, quarters.lower_right);
}
