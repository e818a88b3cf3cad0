#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "bounces/samples.glsl"
#include "bounces/sum_of_lanes.glsl"
#include "caches/arriving.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/disc.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "lib/weighted_draw.glsl"

// One group of invocations a sample of the surfaces: the irradiance from all virtual area lights of the light views, W/m²,
//
//   E(s) = Σ_g V_g Σ_{i in g} Φ_i/π · F_i(s)
//
// F of lib/disc.glsl, V_g a ray to one light of the group, another one for each sample. Each invocation takes every 64th group.

layout(local_size_x = 64) in;

// 1: lights have their area, the paper, in place of that over π; here they are discs all the same.
layout(constant_id = 0) const uint PAPER = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer samples;
layout(set = 0, binding = 1) buffer ArrivedBlock { vec4 arrived[]; };

layout(push_constant, scalar) uniform Push {
    vec3 shift;        // from render space to the rays' space
    uint slot_count;
    int first_group;
    int end_group;
} push;

// One light gets a ray, drawn by what each gives: what comes of lights that are hidden in part is right in the mean.
vec3 from_group(SurfaceSample point, vec3 position_rs, LightGroup group, uint seed) {
    WeightedDraw draw = start_draw(seed);
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (int number = group.first; number < group.end; ++number) {
        Vpl light = as_disc(load_area_light(number));
        light.area_over_pi *= PAPER != 0u ? INVERSE_PI : 1.0;
        vec3 given = light.strength * disc_form_factor(light, position_rs, point.normal);
        float largest = max3(given);
        if (largest > 0.0) {
            sum += given;
            offer(draw, number, largest);
        }
    }
    if (draw.drawn >= 0) {
        vec3 origin = offset_ray_origin(point.position, point.normal);
        vec3 way = lifted_vpl(load_area_light(draw.drawn)) + push.shift - origin;
        sum = is_occluded(origin, way, 1.0) ? vec3(0.0) : sum;
    }
    return sum;
}

void main() {
    uint self = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (self >= push.slot_count) {
        return;
    }
    SurfaceSample point = load_sample(samples, self);
    vec3 position_rs = point.position - push.shift;
    int end = point.area > 0.0 ? min(push.end_group, int(texelFetch(area_light_counts, 1).x)) : 0;
    vec3 found = vec3(0.0);
    for (int index = push.first_group + int(gl_LocalInvocationIndex); index < end; index += 64) {
        uint seed = mix_bits(self * 0x9E3779B9u + uint(index));
        found += from_group(point, position_rs, load_light_group(area_light_groups, index), seed);
    }
    vec3 sum = sum_of_lanes(found);
    if (gl_LocalInvocationIndex == 0u) {
        arrived[self] = vec4(push.first_group > 0 ? arrived[self].rgb + sum : sum, 0.0);
    }
}
