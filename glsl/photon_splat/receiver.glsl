// The surface that a sample of the lattice stands for.
#ifndef PHOTON_SPLAT_RECEIVER
#define PHOTON_SPLAT_RECEIVER

#include "lib/octahedral.glsl"
#include "lib/scene.glsl"
#include "photon_splat/lattice.glsl"

struct Receiver {
    vec3 position_rs;
    vec3 normal;  // geometric
    bool valid;   // there is a surface
};

// Of the image's pixel; one outside of it has no surface.
Receiver load_receiver(Camera camera, sampler2D depth, usampler2D surface, ivec2 pixel, ivec2 image_size) {
    float pixel_depth = pixel.x >= 0 && is_inside(pixel, image_size) ? texelFetch(depth, pixel, 0).x : 0.0;
    if (pixel_depth <= 0.0) {
        return Receiver(vec3(0.0), vec3(0.0), false);
    }
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, image_size), pixel_depth);
    return Receiver(position_rs, unpack_direction(texelFetch(surface, pixel, 0).y), true);
}

#endif
