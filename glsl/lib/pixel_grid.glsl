// Where pixels are, in any stage.
#ifndef LIB_PIXEL_GRID
#define LIB_PIXEL_GRID

bool is_inside(ivec2 pixel, ivec2 size) {
    return all(lessThan(pixel, size));
}

// Normalised device coordinates of a pixel's centre, y down.
vec2 ndc_of_pixel(ivec2 pixel, ivec2 size) {
    return (2.0 * vec2(pixel) + 1.0) / vec2(size) - 1.0;
}

#endif
