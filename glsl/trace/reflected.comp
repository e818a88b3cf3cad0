#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/finite.glsl"
#include "lib/mirrored.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// What a smooth surface at one pixel's centre shows, for marks.comp: the sums over all points y that it comes to, with their weights w, of direct light and what
// shines by itself, of albedo and of normals
//
//   Σ w·L(y)      Σ w·ρ(y)      Σ max(w)·n(y)
//
// Rough surfaces show by chance what they do: they count as showing nothing. The light is that of punctual lights: of others noise would show, and their shadows
// are soft.

layout(local_size_x = 64) in;

// 1: some light has no noise.
layout(constant_id = 0) const uint HAS_LIGHT = 0u;

layout(set = 0, binding = 0) uniform usampler2D heads;
layout(set = 0, binding = 1) uniform sampler2D shining;
layout(set = 0, binding = 2) uniform usamplerBuffer points;
layout(set = 0, binding = 3) uniform samplerBuffer light;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D reflected_light;
layout(set = 0, binding = 5, rgba32ui) writeonly uniform uimage2D reflected_surface;  // albedo, normal: half floats

// Below it neighbours that show the same thing show it alike.
const float SHARP_ROUGHNESS = 0.2;

layout(push_constant, scalar) uniform Push { uint first_row; } push;

void main() {
    ivec2 pixel = pixel_of_invocation() + ivec2(0, push.first_row);
    if (!is_inside(pixel, imageSize(reflected_light))) {
        return;
    }
    vec3 radiance = vec3(0.0);
    vec3 albedo = vec3(0.0);
    vec3 normal = vec3(0.0);
    float roughness = unpack_surface(vec3(0.0), texelFetch(surface, pixel, 0), vec4(0.0)).roughness;
    if (roughness < SHARP_ROUGHNESS) {
        radiance = texelFetch(shining, pixel, 0).rgb;
        uint next = texelFetch(heads, pixel, 0).x;
        [[dont_unroll]] while (next != 0u) {
            uint index = next - 1u;
            Mirrored point = load_mirrored(points, index);
            vec3 found = HAS_LIGHT != 0u ? texelFetch(light, int(index)).rgb : vec3(0.0);
            radiance += is_finite(found) ? found : vec3(0.0);
            albedo += point.weight * (point.surface.diffuse_albedo + point.surface.f0);
            normal += max3(point.weight) * point.surface.normal;
            next = point.next;
        }
    }
    imageStore(reflected_light, pixel, vec4(radiance, 0.0));
    imageStore(
        reflected_surface, pixel,
        uvec4(packHalf2x16(albedo.rg), packHalf2x16(vec2(albedo.b, normal.x)), packHalf2x16(normal.yz), 0u));
}
