#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/microfacet.glsl"
#include "lib/pixel_rays.glsl"
#include "lib/pixels.glsl"
#include "lib/sobol.glsl"
#include "lib/surface_packing.glsl"

// Ambient occlusion (Landis, Production-Ready Global Illumination, SIGGRAPH 2002, course 16) in the slot `diffuse` of one pixel: what x's diffuse
// lobe scatters of a sky of the same radiance everywhere, as far as no surface nearer than R hides it,
//
//   L(x) = ρ/π ∫ L_sky V_R(x, ω) (n·ω)⁺ dω ≈ ρ·L_sky · 1/N Σ_i V_R(x, ω_i)      W/(m²·sr)
//
// with directions ω_i drawn by the cosine, and ρ = indirect_diffuse_albedo().

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, rgba32f) writeonly uniform image2D diffuse;

layout(push_constant, scalar) uniform Push {
    vec3 shift;         // from the G-buffer's render space to that of rays
    uint ray_count;
    vec3 sky_radiance;  // W/(m²·sr)
    float reach;        // m
} push;

float visible_share(ivec2 pixel, Surface point, vec3 position_rs) {
    vec3 origin = pixel_ray_origin(position_rs, push.shift, point.geometric_normal);
    Frame frame = frame_around(point.normal);
    uint seed = seed_of_pixel(pixel);
    uint seen = 0u;
    [[dont_unroll]] for (uint i = 0u; i < push.ray_count; ++i) {
        vec3 direction = to_world(frame, sample_cosine_hemisphere(sobol_sample(sobol, i, seed).xy));
        if (dot(direction, point.geometric_normal) > 0.0 && !is_occluded(origin, direction, push.reach)) {
            ++seen;
        }
    }
    return float(seen) / float(push.ray_count);
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec3 radiance = vec3(0.0);
    if (pixel_depth > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 albedo = indirect_diffuse_albedo(point);
        if (max3(albedo) > 0.0) {
            radiance = albedo * push.sky_radiance * visible_share(pixel, point, position_rs);
        }
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
