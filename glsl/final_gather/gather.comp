#version 460
#include "lib/prelude.glsl"
#include "groups/photon_map.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/pixel_rays.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// The slot `diffuse` of one pixel by gather rays (Jensen 1996), some of them in each pass: L(x) = ρ/π·E(x) with the pixel's own albedo ρ =
// indirect_diffuse_albedo().

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, rgba32f) uniform image2D diffuse;

layout(push_constant, scalar) uniform Push {
    vec3 shift;  // from the G-buffer's render space to that of rays
    GatherRays rays;
} push;

#include "final_gather/incoming.glsl"

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = push.rays.first > 0u ? imageLoad(diffuse, pixel).rgb : vec3(0.0);
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    if (pixel_depth > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 albedo = indirect_diffuse_albedo(point);
        if (max3(albedo) > 0.0) {
            vec3 origin = pixel_ray_origin(position_rs, push.shift, point.geometric_normal);
            vec3 irradiance = irradiance_by_rays(origin, point.normal, point.geometric_normal, seed_of_pixel(pixel));
            radiance += albedo * irradiance * INVERSE_PI;
        }
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
