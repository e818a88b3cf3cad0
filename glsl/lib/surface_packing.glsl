// The G-buffer's texel. `surface` (rgba32ui): shading normal | geometric normal | albedo r, g (half) | albedo b (half),
// roughness (unorm16). `specular` (rgba16f): f0, f90; a scene without specular lobes has no such image and reads as zero.
#ifndef LIB_SURFACE_PACKING
#define LIB_SURFACE_PACKING

#include "lib/brdf.glsl"
#include "lib/octahedral.glsl"

uvec4 pack_surface(vec3 normal, vec3 geometric_normal, Lobes lobes) {
    vec3 albedo = clamp(lobes.diffuse_albedo, 0.0, 1.0);
    uint roughness = uint(clamp(lobes.roughness, 0.0, 1.0) * 65535.0 + 0.5);
    return uvec4(
        pack_direction(normal), pack_direction(geometric_normal),
        packHalf2x16(albedo.rg), (packHalf2x16(vec2(albedo.b, 0.0)) & 0xFFFFu) | roughness << 16);
}

vec4 pack_specular(Lobes lobes) {
    return clamp(vec4(lobes.f0, lobes.f90), 0.0, 1.0);
}

Surface unpack_surface(vec3 position_rs, uvec4 surface, vec4 specular) {
    return Surface(
        position_rs, unpack_direction(surface.x), unpack_direction(surface.y),
        vec3(unpackHalf2x16(surface.z), unpackHalf2x16(surface.w & 0xFFFFu).x),
        specular.rgb, specular.a, float(surface.w >> 16) / 65535.0);
}

#endif
