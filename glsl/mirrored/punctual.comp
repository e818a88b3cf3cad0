#version 460
#include "lib/prelude.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "mirrored/points.glsl"
#include "lib/punctual_light.glsl"

// What punctual lights send to one listed point, and it to its pixel: w · Σ_i f(l_i, v) · E⊥_i · (n·l_i)⁺ · V_i, one ray a light.

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push { uint light_count; } push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (!is_listed(index)) {
        return;
    }
    Mirrored point = load_mirrored(mirrored_points, index);
    Receiver receiver = receiver_of(point);
    vec3 radiance = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < push.light_count; ++i) {
        radiance += reflected_radiance(receiver, load_light(punctual_lights, i));
    }
    add_light(index, point.weight * radiance);
}
