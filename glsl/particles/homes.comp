#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// The particle that stands for the surface at one pixel (seen_home.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, r32ui) writeonly uniform uimage2D homes;
layout(set = 0, binding = 1) buffer Marks { uint marks[]; };

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

#include "particles/seen_home.glsl"

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
            home = seen_home(position_rs + push.shift, point.geometric_normal, direction_to_eye(camera, position_rs), 3e38);
        }
    }
    imageStore(homes, pixel, uvec4(home, 0u, 0u, 0u));
}
