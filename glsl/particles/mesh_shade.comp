#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/surface.glsl"
#include "lib/octahedral.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// The slot `diffuse` of one pixel, W/(m²·sr): L(x) = ρ/π·E(x), with the pixel's own albedo ρ = indirect_diffuse_albedo() and E of mesh_interpolate.glsl.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usampler2D spots;
layout(set = 0, binding = 1) uniform usamplerBuffer tessellation;
layout(set = 0, binding = 2) uniform usamplerBuffer particle_marks;
layout(set = 0, binding = 3) uniform usamplerBuffer marked_before;
layout(set = 0, binding = 4) uniform samplerBuffer radiance_particles;
layout(set = 0, binding = 5) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 6) uniform usamplerBuffer lists;
layout(set = 0, binding = 7) uniform samplerBuffer irradiance;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image2D diffuse;

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

#include "particles/mesh_interpolate.glsl"

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    uvec4 spot = texelFetch(spots, pixel, 0);
    if (spot.xy != NOTHING_SEEN.xy) {
        float pixel_depth = texelFetch(depth, pixel, 0).x;
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        radiance = indirect_diffuse_albedo(point) * irradiance_at_spot(spot, position_rs + push.shift, point.normal) * INVERSE_PI;
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
