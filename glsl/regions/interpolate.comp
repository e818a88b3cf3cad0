#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/pixels.glsl"
#include "lib/octahedral.glsl"
#include "lib/vectors.glsl"
#include "regions/regions.glsl"

// Irradiance of the four squares of level l >= 1 that make up one flat region of level l + 1 (regions/upsample.glsl). No square that is read
// on level l is written here: those were gathered, because the region that they make up is not flat.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D square_planes;
layout(set = 0, binding = 1) uniform sampler2D region_planes;
layout(set = 0, binding = 2, rgba32f) uniform image2D irradiance;

layout(push_constant, scalar) uniform Push {
    ivec2 size;              // pixels
    int level;
    float depth_threshold;
    float normal_threshold;
} push;

vec4 irradiance_at(ivec2 texel) {
    return imageLoad(irradiance, texel);
}

float depth_of_square(ivec2 cell) {
    return texelFetch(square_planes, cell, 0).x;
}

#include "regions/upsample.glsl"

void main() {
    ivec2 region = pixel_of_invocation();
    if (!is_inside(region, size_of_level(push.size, push.level + 1))) {
        return;
    }
    vec4 plane = texelFetch(region_planes, region, 0);
    if (plane.x > 0.0) {
        Upsampling by = Upsampling(push.size, push.level, push.depth_threshold, unit_of_depth(camera), push.normal_threshold);
        Quarters quarters = upsampled(by, region, plane);
        ivec2 first = place_of_level(push.size, push.level) + 2 * region;
        imageStore(irradiance, first, vec4(quarters.upper_left, quarters.normal));
        imageStore(irradiance, first + ivec2(1, 0), vec4(quarters.upper_right, quarters.normal));
        imageStore(irradiance, first + ivec2(0, 1), vec4(quarters.lower_left, quarters.normal));
        imageStore(irradiance, first + ivec2(1, 1), vec4(quarters.lower_right, quarters.normal));
    }
}
