#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "vpl/regions.glsl"

// The slot `diffuse` of one pixel: L = ρ/π · E [W/(m²·sr)], ρ = indirect_diffuse_albedo(). E is what was gathered at the pixel, or comes
// from the regions of 2x2 pixels if one covers it (vpl/upsample.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D surface;
layout(set = 0, binding = 2) uniform sampler2D specular;
layout(set = 0, binding = 3) uniform sampler2D planes;
layout(set = 0, binding = 4) uniform sampler2D irradiance;
layout(set = 0, binding = 5, rgba32f) writeonly uniform image2D diffuse;

layout(push_constant, scalar) uniform Push {
    float depth_threshold;
    float depth_scale;
    float normal_threshold;
    uint has_specular;  // 0: no material has a specular lobe, `specular` is not read
} push;

vec4 irradiance_at(ivec2 texel) {
    return texelFetch(irradiance, texel, 0);
}

float depth_of_square(int level, ivec2 cell) {
    return texelFetch(depth, cell, 0).x;
}

#include "vpl/upsample.glsl"

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    if (texelFetch(depth, pixel, 0).x > 0.0) {
        vec4 lobe = push.has_specular != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(vec3(0.0), texelFetch(surface, pixel, 0), lobe);
        Upsampling by = Upsampling(size, 0, push.depth_threshold, push.depth_scale, push.normal_threshold);
        vec4 received = is_flat(planes, size, 1, pixel / 2) ? upsampled(by, pixel) : irradiance_at(pixel);
        radiance = received.rgb * (indirect_diffuse_albedo(point) * INVERSE_PI);
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
