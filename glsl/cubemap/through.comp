#version 460
#include "lib/prelude.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/finite.glsl"
#include "lib/hit_vertex.glsl"
#include "lib/pixels.glsl"
#include "lib/ray_offset.glsl"

// Where what a pixel sees through glass comes from: the line of sight, refracted at all glass on its way as if that were smooth, up to the last surface of it. What of
// the radiance there comes to the pixel,
//
//   w = Π (1 − F) · tint · e^(−absorption · way) / η²        η the index beyond a surface over that before it
//
// is 0 where a pixel shows no glass. Reflections within the glass are those beyond the critical angle alone.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, rgba32ui) writeonly uniform uimage2D exits;      // place in render space, packed direction
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D transmitted;  // w

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

// Of the distance to the camera: what the depth buffer's rounding may amount to, many times over.
const float NEAR = 1.0 / 4096.0;
const uint MOST_MET = 12u;

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(exits);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec3 position_rs = pixel_depth > 0.0 ? position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth) : vec3(0.0);
    vec3 direction = pixel_depth > 0.0 ? -direction_to_eye(camera, position_rs) : vec3(0.0, 0.0, 1.0);
    float away = camera.depth_range > 0.0 ? camera.depth_range : distance(camera.position_rs, position_rs);
    vec3 origin = position_rs + push.shift - direction * (NEAR * away);
    vec3 weight = vec3(1.0);
    bool through = false;
    // The first ray finds the triangle that the pixel shows.
    [[dont_unroll]] for (uint met_count = 0u; met_count < MOST_MET && pixel_depth > 0.0; ++met_count) {
        Hit hit = closest_hit(origin, direction, met_count == 0u ? 2.0 * NEAR * away : 3e38);
        if (hit.triangle == NO_TRIANGLE) {
            break;
        }
        Triangle triangle = load_triangle(triangles, hit.triangle);
        HitVertex met = vertex_of_hit(triangle, hit, origin, direction, Footprint(vec4(0.0), vec4(0.0)));
        if (met.unlit || max3(met.matter.transmission) <= 0.0) {
            break;
        }
        weight *= through ? met.transmittance : vec3(1.0);
        float cosine = clamp(-dot(direction, met.normal), 1e-4, 1.0);
        float index = met.matter.relative_ior;
        vec3 refracted = index == 1.0 ? direction : refract(direction, met.normal, 1.0 / index);
        if (dot(refracted, refracted) > 0.5 && dot(refracted, met.face) < 0.0) {
            weight *= met.matter.transmission * ((1.0 - max3(fresnel(met.matter, cosine))) / (index * index));
            direction = refracted;
            origin = offset_ray_origin(met.position, -met.face);
            through = true;
        } else if (through) {
            vec3 mirrored = reflect(direction, met.normal);
            direction = dot(mirrored, met.face) > 0.0 ? mirrored : reflect(direction, met.face);
            origin = offset_ray_origin(met.position, met.face);
        } else {
            break;
        }
    }
    through = through && is_finite(weight);
    imageStore(exits, pixel, uvec4(floatBitsToUint(origin - push.shift), pack_direction(direction)));
    imageStore(transmitted, pixel, vec4(through ? weight : vec3(0.0), 0.0));
}
