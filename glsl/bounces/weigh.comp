#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "bounces/samples.glsl"
#include "lib/color.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "lib/vpl.glsl"

// How much one slot of a virtual area light matters to samples of the surfaces: the irradiance that it gives to some of them, which are drawn, each with a ray (luminance, over
// that of all slots it has no unit that matters), and its flux. caches/weigh.comp does the same for points of the picture.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer slots;
layout(set = 0, binding = 1) writeonly buffer MatterBlock { vec2 matter[]; };  // caches/pyramid.glsl, level 0
layout(set = 0, binding = 2) uniform usamplerBuffer samples;

layout(push_constant, scalar) uniform Push {
    vec3 shift;  // from render space to the rays' space
    uint slot_count;
    uint sample_count;
    uint ray_count;
} push;

float given_to(SurfaceSample point, Vpl light) {
    float form = vpl_form_factor(light, point.position - push.shift, point.normal);
    float given = point.area > 0.0 ? luminance(light.strength) * form : 0.0;
    if (given > 0.0) {
        vec3 origin = offset_ray_origin(point.position, point.normal);
        given = is_occluded(origin, lifted_vpl(light) + push.shift - origin, 1.0) ? 0.0 : given;
    }
    return given;
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.slot_count) {
        return;
    }
    vec4 first = texelFetch(slots, int(2u * slot));
    vec4 second = texelFetch(slots, int(2u * slot + 1u));
    float given = 0.0;
    float flux = luminance(second.rgb);
    if (flux > 0.0) {
        Vpl light = unpack_vpl(first, second);
        uint seed = seed_of(slot, 0x5A3Du);
        [[dont_unroll]] for (uint ray = 0u; ray < push.ray_count; ++ray) {
            uint number = uint(sobol_sample(sobol, ray, seed).x * float(push.sample_count));
            given += given_to(load_sample(samples, min(number, push.sample_count - 1u)), light);
        }
        flux *= length(light.normal);
    }
    matter[slot] = vec2(given, flux);
}
