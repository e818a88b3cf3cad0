#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "groups/scene_rays.glsl"
#include "lib/color.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/octahedral.glsl"
#include "lib/pixel_grid.glsl"
#include "lib/pixel_rays.glsl"
#include "lib/sobol.glsl"
#include "lib/vpl.glsl"

// How much one slot of a virtual area light matters: the irradiance that it gives to points of the picture in the mean, of which a few are drawn, each with a ray
// (luminance, over that of the whole picture it has no unit that matters), and its flux.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer slots;
layout(set = 0, binding = 1) writeonly buffer MatterBlock { vec2 matter[]; };  // caches/pyramid.glsl, level 0

layout(push_constant, scalar) uniform Push {
    vec3 shift;  // from render space to the rays' space
    uint slot_count;
    uint ray_count;
} push;

float given_to(ivec2 pixel, ivec2 size, Vpl light) {
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    if (pixel_depth <= 0.0) {
        return 0.0;
    }
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    vec3 normal = unpack_direction(texelFetch(surface, pixel, 0).y);
    normal = dot(normal, direction_to_eye(camera, position_rs)) < 0.0 ? -normal : normal;
    float given = luminance(light.strength) * vpl_form_factor(light, position_rs, normal);
    if (given > 0.0) {
        vec3 origin = pixel_ray_origin(position_rs, push.shift, normal);
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
        ivec2 size = textureSize(depth, 0);
        uint seed = seed_of(slot, 0x5EEDu);
        [[dont_unroll]] for (uint ray = 0u; ray < push.ray_count; ++ray) {
            vec2 place = sobol_sample(sobol, ray, seed).xy;
            given += given_to(min(ivec2(place * vec2(size)), size - 1), size, light);
        }
        flux *= length(light.normal);
    }
    matter[slot] = vec2(given, flux);
}
