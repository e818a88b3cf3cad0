#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"

// The slot that an estimator has filled, at one pixel of some rows: the mean of its samples, radiance in W/(m²·sr), three floats a pixel, row by
// row.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer Means { float means[]; };
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D slot;

layout(push_constant, scalar) uniform Push {
    uint first_row;
    uint row_count;
} push;

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = ivec2(imageSize(slot).x, push.row_count);
    if (!is_inside(pixel, size)) {
        return;
    }
    int first = 3 * (pixel.y * size.x + pixel.x);
    imageStore(slot, pixel + ivec2(0, push.first_row), vec4(means[first], means[first + 1], means[first + 2], 1.0));
}
