// The surface at one pixel's centre, for kernels that send rays from it, and the slot `direct` as far as earlier kernels have filled it.
// The scene that rays meet has an origin of its own: `shift` leads from the G-buffer's render space to that.
#ifndef DIRECT_RECEIVER
#define DIRECT_RECEIVER

#include "groups/direct_sum.glsl"
#include "groups/surface.glsl"
#include "lib/pixels.glsl"
#include "lib/sobol.glsl"
#include "lib/surface_packing.glsl"
#include "lib/receiver.glsl"

#include "lib/pixel_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

Receiver load_receiver(ivec2 pixel, ivec2 size, float pixel_depth, vec3 shift) {
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    vec4 lobe = SPECULAR_LOBES != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    Receiver receiver;
    receiver.surface = unpack_surface(position_rs + shift, texelFetch(surface, pixel, 0), lobe);
    receiver.to_eye = direction_to_eye(camera, position_rs);
    receiver.ray_origin = pixel_ray_origin(position_rs, shift, receiver.surface.geometric_normal);
    return receiver;
}

void store_direct(ivec2 pixel, vec3 radiance) {
    if (ADDS != 0u) {
        radiance += texelFetch(before, pixel, 0).rgb;
    }
    imageStore(direct, pixel, vec4(radiance, 1.0));
}

#endif
