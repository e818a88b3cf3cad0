// The pixels that irradiance is splatted to: every `downscale`-th of the G-buffer's, a lattice of samples of its surfaces. So no second
// G-buffer is drawn, and no sample mixes two surfaces. Splat coordinates are continuous, in samples: sample i is at i + ½.
#ifndef PHOTON_SPLAT_LATTICE
#define PHOTON_SPLAT_LATTICE

#include "lib/pixel_grid.glsl"

ivec2 lattice_size(ivec2 image_size, int downscale) {
    return (image_size + downscale - 1) / downscale;
}

// The image's pixel that a sample stands at: near the middle of its block.
ivec2 pixel_of_sample(ivec2 place, ivec2 image_size, int downscale) {
    return min(place * downscale + downscale / 2, image_size - 1);
}

// From the image's continuous coordinates, in pixels. A sample of a block that the image's edge cuts may stand up to half a unit before the
// place that this gives it.
vec2 splat_coordinates(vec2 pixels, int downscale) {
    return (pixels - float(downscale / 2) - 0.5) / float(downscale) + 0.5;
}

#endif
