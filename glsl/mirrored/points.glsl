// One listed point an invocation, and the light that it sends to its pixel as far as earlier kernels have found it.
#ifndef MIRRORED_POINTS
#define MIRRORED_POINTS

#include "groups/mirrored.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/mirrored.glsl"
#include "lib/ray_offset.glsl"
#include "lib/receiver.glsl"

// 1: earlier kernels found some.
layout(constant_id = 0) const uint ADDS_LIGHT = 0u;

layout(set = 0, binding = 0) buffer LightBlock { vec4 light[]; };  // W/(m²·sr) at the pixel

bool is_listed(uint index) {
    return index < texelFetch(mirrored_count, 3).x;
}

Receiver receiver_of(Mirrored point) {
    Surface surface = point.surface;
    return Receiver(surface, point.to_viewer, offset_ray_origin(surface.position_rs, surface.geometric_normal));
}

void add_light(uint index, vec3 radiance) {
    vec3 before = ADDS_LIGHT != 0u ? light[index].rgb : vec3(0.0);
    light[index] = vec4(before + radiance, 0.0);
}

#endif
