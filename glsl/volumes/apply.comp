#version 460
#include "lib/prelude.glsl"
#include "caches/asking.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "caches/pixel_origin.glsl"

// The slot `diffuse` of one pixel: radiance in W/(m²·sr), L(x) = ρ/π · E(x), with ρ = indirect_diffuse_albedo() and the irradiance E of the caches around x
// (volumes/irradiance.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer light;  // volumes/light.comp
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D diffuse;
layout(set = 0, binding = 2) buffer MissingBlock { uint missing[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    uint capacity;
} push;

#include "volumes/irradiance.glsl"

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    if (pixel_depth > 0.0) {
        vec3 position_rs = asking_position(ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 response = indirect_diffuse_albedo(point) * INVERSE_PI;
        if (max3(response) > 0.0) {
            vec3 origin = WEIGHTS == WEIGHTS_RAYS ? origin_of_pixel(point, push.rays) : vec3(0.0);
            uint absent;
            radiance = response * irradiance_at(position_rs, point.normal, push.rays, origin, push.capacity, absent);
            if (absent > 0u) {
                atomicAdd(missing[0], absent);
            }
        }
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
