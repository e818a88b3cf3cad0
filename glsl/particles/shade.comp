#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/surface.glsl"
#include "lib/octahedral.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// The slot `diffuse` of one pixel, W/(m²·sr): L(x) = ρ/π·E(x), with the pixel's own albedo ρ = indirect_diffuse_albedo() and E of irradiance.glsl.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usampler2D homes;
layout(set = 0, binding = 1) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 2) uniform usamplerBuffer lists;
layout(set = 0, binding = 3) uniform samplerBuffer irradiance;  // and the area of each
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D diffuse;

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

#include "particles/irradiance.glsl"

const uint NO_PARTICLE = 0xFFFFFFFFu;

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    uint home = texelFetch(homes, pixel, 0).x;
    if (home != NO_PARTICLE) {
        float pixel_depth = texelFetch(depth, pixel, 0).x;
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 received = irradiance_at(position_rs + push.shift, point.normal, home);
        radiance = indirect_diffuse_albedo(point) * received * INVERSE_PI;
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
