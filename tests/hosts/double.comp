#version 460

// What a host makes of an image that the library filled: four floats a pixel, twice what they were.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, rgba32f) uniform readonly image2D pixels;
layout(set = 0, binding = 1) writeonly buffer Doubled { vec4 doubled[]; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(pixels);
    if (pixel.x < size.x && pixel.y < size.y) {
        doubled[pixel.y * size.x + pixel.x] = 2.0 * imageLoad(pixels, pixel);
    }
}
