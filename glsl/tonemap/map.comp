#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/tonemap.glsl"
#include "tonemap/adaptation.glsl"

// The display value of one pixel: tone curve (lib/tonemap.glsl), sRGB encoding, 8 bits a channel in row order, red in the lowest byte.
//   linear   the radiance as it is, clamped to 0 … 1
//   aces     exposed so that the logarithmic average lies at the photographic middle grey, 0.18
//   drago    in units of the logarithmic average, bias 0.85
// Both curves scale with the scene: twice the power gives the same display.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D image;
layout(set = 0, binding = 1) readonly buffer AdaptationBlock { Adaptation adaptation; };
layout(set = 0, binding = 2) writeonly buffer Display { uint display[]; };

const uint MODE_LINEAR = 0u;
const uint MODE_ACES = 1u;
const uint MODE_DRAGO = 2u;

layout(push_constant, scalar) uniform Push { uint mode; } push;

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = textureSize(image, 0);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 color = max(texelFetch(image, pixel, 0).rgb, vec3(0.0));
    if (push.mode == MODE_ACES) {
        color = tonemap_aces(color * (0.18 / max(adaptation.log_average, SMALLEST_LUMINANCE)));
    } else if (push.mode == MODE_DRAGO) {
        vec3 scaled = color / max(adaptation.log_average, SMALLEST_LUMINANCE);
        float maximum = adaptation.maximum / max(adaptation.log_average, SMALLEST_LUMINANCE);
        color = scaled * tonemap_drago_scale(luminance(scaled), maximum, 0.85);
    }
    display[pixel.y * size.x + pixel.x] = packUnorm4x8(vec4(srgb_encode(clamp(color, 0.0, 1.0)), 1.0));
}
