#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "lightmaps/seen.glsl"

// The slot `diffuse` of one pixel: L(x) = ρ/π·E(x), E interpolated between the texels of the indirect illumination map, with the pixel's own albedo ρ =
// indirect_diffuse_albedo(), so that textures stay sharp.

layout(local_size_x = 64) in;

// 1: maps by themselves, as on white surfaces.
layout(constant_id = 0) const uint WHITE = 0u;

layout(set = 0, binding = 0, rgba32f) writeonly uniform image2D diffuse;
layout(set = 0, binding = 1) uniform samplerBuffer map;   // the IIM, or, to look at, the AIM

layout(push_constant, scalar) uniform Push { vec3 shift; } push;   // from the G-buffer's render space to that of rays

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    if (pixel_depth > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 albedo = indirect_diffuse_albedo(point);
        if (max3(albedo) > 0.0) {
            vec3 irradiance = seen_irradiance(
                position_rs + push.shift, point.geometric_normal, direction_to_eye(camera, position_rs),
                viewer_distance(camera, position_rs), map);
            radiance = (WHITE != 0u ? vec3(1.0) : albedo) * INVERSE_PI * irradiance;
        }
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
