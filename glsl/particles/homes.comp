#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "particles/home.glsl"

// The particle that stands for the surface at one pixel, by the rule of links; it is marked as used.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, r32ui) writeonly uniform uimage2D homes;
layout(set = 0, binding = 1) buffer Marks { uint marks[]; };

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

// Cosine.
const float EDGE_ON = 0.02;

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(homes);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    uint home = NO_PARTICLE;
    if (pixel_depth > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        if (max3(indirect_diffuse_albedo(point)) > 0.0) {
            vec3 normal = point.geometric_normal;
            vec3 position = position_rs + push.shift;
            vec3 to_eye = direction_to_eye(camera, position_rs);
            vec3 from = lifted(position, normal, to_eye, 3e38, spacing_of_particles());
            home = home_of(position, normal, from);
            // Edge-on, rounding decides which side a pixel sees.
            if (home == NO_PARTICLE && dot(to_eye, normal) < EDGE_ON) {
                home = home_of(position, -normal, from);
            }
            // A thing smaller than the spacing, on which no particle came to lie, gets the light of what is around.
            if (home == NO_PARTICLE) {
                home = home_among(position, normal, from, NOT_OPPOSITE, false);
            }
        }
    }
    if (home != NO_PARTICLE) {
        atomicOr(marks[home], 1u);
    }
    imageStore(homes, pixel, uvec4(home, 0u, 0u, 0u));
}
