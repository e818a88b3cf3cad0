#version 460
#include "lib/prelude.glsl"
#include "groups/light_caches.glsl"
#include "caches/arriving.glsl"
#include "lib/color.glsl"
#include "radiance_maps/of_map.glsl"

// One group a map: more light than may come to its cache, W/m², of the brightest channel: of all virtual area lights, without anything in between and without their cosines,
//
//   Σ_i 4 Φ_i/π / max(a_i, (d_i − s_i)²)
//
// s_i the side of a square of the light's area. Each invocation adds up every 64th light, the first one what they found: a fixed order.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer map_head;
layout(set = 0, binding = 1) uniform usamplerBuffer map_caches;
layout(set = 0, binding = 2) writeonly buffer BoundBlock { float bounds[]; };

layout(push_constant, scalar) uniform Push {
    uint capacity;
} push;

shared float found[64];

void main() {
    uint map = map_of_group();
    if (map >= min(texelFetch(map_head, 3).x, push.capacity)) {
        return;
    }
    vec3 position_rs = position_of_cache(texelFetch(map_caches, int(map)).x);
    int count = int(texelFetch(area_light_counts, 0).x);
    float sum = 0.0;
    for (int index = int(gl_LocalInvocationIndex); index < count; index += 64) {
        Vpl light = load_area_light(index);
        vec3 way = light.position_rs - position_rs;
        if (dot(light.normal, way) < 0.0) {
            float apart = max(length(way) - sqrt(PI * light.area_over_pi), 0.0);
            sum += 4.0 * length(light.normal) * max3(light.strength) / max(light.area_over_pi, apart * apart);
        }
    }
    found[gl_LocalInvocationIndex] = sum;
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        float bound = 0.0;
        [[dont_unroll]] for (int lane = 0; lane < 64; ++lane) {
            bound += found[lane];
        }
        bounds[map] = bound;
    }
}
