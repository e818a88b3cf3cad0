#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/octahedral.glsl"
#include "lib/vectors.glsl"
#include "vpl/regions.glsl"

// Irradiance of one square of level l >= 1 that a larger region covers, from the level above (vpl/upsample.glsl). A level's squares read no
// squares of that level which are written here: those that a larger region does not cover keep what was gathered.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D planes;
layout(set = 0, binding = 1, rgba32f) uniform image2D irradiance;

layout(push_constant, scalar) uniform Push {
    ivec2 size;              // pixels
    int level;
    float depth_threshold;
    float depth_scale;
    float normal_threshold;
} push;

vec4 irradiance_at(ivec2 texel) {
    return imageLoad(irradiance, texel);
}

float depth_of_square(int level, ivec2 cell) {
    return texelFetch(planes, cell, level - 1).x;
}

#include "vpl/upsample.glsl"

void main() {
    ivec2 cell = pixel_of_invocation();
    if (all(lessThan(cell, size_of_level(push.size, push.level))) && is_flat(planes, push.size, push.level + 1, cell / 2)) {
        Upsampling by = Upsampling(push.size, push.level, push.depth_threshold, push.depth_scale, push.normal_threshold);
        imageStore(irradiance, place_of_level(push.size, push.level) + cell, upsampled(by, cell));
    }
}
