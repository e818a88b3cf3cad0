#version 460
#include "lib/prelude.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/finite.glsl"
#include "lib/mirrored.glsl"
#include "lib/pixel_rays.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "trace/walking.glsl"

// Follows reflections and refractions from the surface at one pixel (Whitted 1980; the preliminary pass of Chang et al. 4.3.1). Lists each surface that they
// come to, with what of its radiance the pixel sees,
//
//   L(x, v) = Σ w · L(y),     w = Π f|cos|/p over the specular events on the way
//
// and sums up what they meet that shines by itself. Reflection and refraction are both followed at the first events, later one of the two by its share; ways that
// carry little end by Russian roulette. The light at the listed points is the business of the passes that follow.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D glass;  // glass.comp
layout(set = 0, binding = 1) writeonly buffer Points { MirroredPoint points[]; };
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };  // word 0: points, word 1: rays
layout(set = 0, binding = 3, r32ui) writeonly uniform uimage2D heads;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D shining;

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    uint first_row;
    Walking walking;
    uint lamps;            // 1: what shines is shown behind the first event too: `direct` does not
} push;

#include "trace/ways.glsl"

vec3 shining_sum = vec3(0.0);

void add_shining(uint slot, vec3 radiance) {
    shining_sum += radiance;
}

uint shows_of_first_reflection(bool narrow) {
    return narrow && push.lamps != 0u ? SHOWS_LAMPS | SHOWS_SKY : 0u;
}

// At their finest.
Footprint footprint_of(uint event, Triangle triangle, Hit hit, vec3 origin, vec3 direction) {
    return Footprint(vec4(0.0), vec4(0.0));
}

// The surface at a pixel. Returns whether it has a specular lobe.
bool vertex_of_pixel(ivec2 pixel, ivec2 size, out Vertex vertex) {
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec4 lobe = texelFetch(specular, pixel, 0);
    vec4 behind = TRANSMISSIVE != 0u ? texelFetch(glass, pixel, 0) : vec4(0.0, 0.0, 0.0, 1.0);
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    Surface point = unpack_surface(position_rs + push.shift, texelFetch(surface, pixel, 0), lobe);
    vertex.position = point.position_rs;
    vertex.origin = pixel_ray_origin(position_rs, push.shift, point.geometric_normal);
    vertex.face = point.geometric_normal;
    vertex.normal = point.normal;
    vertex.to_viewer = direction_to_eye(camera, position_rs);
    vertex.matter = Matter(
        point.diffuse_albedo, point.f0, point.f90, max(point.roughness * point.roughness, MINIMUM_ALPHA), behind.rgb, behind.a);
    vertex.weight = vec3(1.0);
    vertex.event = 0u;
    vertex.seed = seed_of_pixel(pixel);
    return pixel_depth > 0.0 && max(max3(lobe.rgb), max(lobe.a, max3(behind.rgb))) > 0.0;
}

void main() {
    ivec2 pixel = pixel_of_invocation() + ivec2(0, push.first_row);
    ivec2 size = imageSize(shining);
    if (!is_inside(pixel, size)) {
        return;
    }
    Vertex first;
    if (vertex_of_pixel(pixel, size, first)) {
        uint number = 0u;
        Vertex vertex = first;
        bool goes_on = true;
        [[dont_unroll]] while (number < sample_count) {
            if (goes_on) {
                send_on(vertex, number);
            }
            if (waiting_count > 0u) {
                goes_on = follow(vertex);
            } else {
                ++number;
                vertex = first;
                goes_on = true;
            }
        }
        if (ray_count > 0u) {
            atomicAdd(counts[1], ray_count);
        }
    }
    imageStore(heads, pixel, uvec4(head));
    imageStore(shining, pixel, vec4(is_finite(shining_sum) ? shining_sum : vec3(0.0), 1.0));
}
