#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"

// The image at one pixel: the sum of the slots that are present, radiance in W/(m²·sr). They split the light paths
// without overlap, so nothing is weighted.
//
// The sky belongs to the slot `emission`, which holds it wherever no surface is (the G-buffer clears it to the sky). A scene in which
// nothing emits needs no such image: without it the sky is added here, at the pixels of depth 0.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D emission;
layout(set = 0, binding = 2) uniform sampler2D direct;
layout(set = 0, binding = 3) uniform sampler2D diffuse;
layout(set = 0, binding = 4) uniform sampler2D caustics;
layout(set = 0, binding = 5) uniform sampler2D specular;
layout(set = 0, binding = 6, rgba32f) writeonly uniform image2D image;

const uint SLOT_EMISSION = 1u;
const uint SLOT_DIRECT = 2u;
const uint SLOT_DIFFUSE = 4u;
const uint SLOT_CAUSTICS = 8u;
const uint SLOT_SPECULAR = 16u;

layout(push_constant, scalar) uniform Push {
    vec3 sky;    // W/(m²·sr)
    uint slots;  // the SLOT_ bits of the images that are present; the others are not read
} push;

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (!is_inside(pixel, imageSize(image))) {
        return;
    }
    vec3 radiance = vec3(0.0);
    if ((push.slots & SLOT_EMISSION) != 0u) {
        radiance += texelFetch(emission, pixel, 0).rgb;
    } else if (texelFetch(depth, pixel, 0).x <= 0.0) {
        radiance += push.sky;
    }
    if ((push.slots & SLOT_DIRECT) != 0u) {
        radiance += texelFetch(direct, pixel, 0).rgb;
    }
    if ((push.slots & SLOT_DIFFUSE) != 0u) {
        radiance += texelFetch(diffuse, pixel, 0).rgb;
    }
    if ((push.slots & SLOT_CAUSTICS) != 0u) {
        radiance += texelFetch(caustics, pixel, 0).rgb;
    }
    if ((push.slots & SLOT_SPECULAR) != 0u) {
        radiance += texelFetch(specular, pixel, 0).rgb;
    }
    imageStore(image, pixel, vec4(radiance, 1.0));
}
