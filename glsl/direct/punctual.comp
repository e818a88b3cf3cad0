#version 460
#include "lib/prelude.glsl"
#include "groups/scene_lights.glsl"
#include "direct/receiver.glsl"
#include "lib/punctual_light.glsl"

// What punctual lights add to the slot `direct` of one pixel, one ray a light:
//
//   L(x, v) = Σ_i f(l_i, v) · E⊥_i(x) · (n·l_i)⁺ · V_i(x)
//
// f: lib/brdf.glsl; E⊥: lib/lights.glsl; V: whether nothing is between x and the light. A light behind the shading normal or behind
// the triangle itself gives nothing.

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    uint light_count;
} push;

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(direct);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec3 radiance = vec3(0.0);
    if (pixel_depth > 0.0) {
        Receiver receiver = load_receiver(pixel, size, pixel_depth, push.shift);
        [[dont_unroll]] for (uint i = 0u; i < push.light_count; ++i) {
            radiance += reflected_radiance(receiver, load_light(punctual_lights, i));
        }
    }
    store_direct(pixel, radiance);
}
