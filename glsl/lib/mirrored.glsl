// A point of a surface that a mirror or glass shows to some pixel, in four texels (rgba32ui):
//
//   position in the rays' space | number of the next point of the pixel, plus 1; 0: none
//   shading normal | normal of the triangle | f90 and roughness (unorm16) | direction to the viewer    packed directions, on the viewer's side
//   diffuse albedo, f0 (half floats) | 1: no mirror shows it, the pixel does
//   what of its radiance comes to the pixel | length of the ray that came there, m
#ifndef LIB_MIRRORED
#define LIB_MIRRORED

#include "lib/brdf.glsl"
#include "lib/octahedral.glsl"

struct MirroredPoint {
    uvec4 place;
    uvec4 directions;
    uvec4 lobes;
    uvec4 weight;
};

struct Mirrored {
    Surface surface;  // position in the rays' space
    vec3 to_viewer;
    vec3 weight;
    uint next;
    float ray_length;
    bool first;
};

MirroredPoint pack_mirrored(Mirrored point) {
    Surface surface = point.surface;
    vec3 albedo = clamp(surface.diffuse_albedo, 0.0, 1.0);
    vec3 f0 = clamp(surface.f0, 0.0, 1.0);
    return MirroredPoint(
        uvec4(floatBitsToUint(surface.position_rs), point.next),
        uvec4(pack_direction(surface.normal), pack_direction(surface.geometric_normal),
              packUnorm2x16(vec2(surface.f90, surface.roughness)), pack_direction(point.to_viewer)),
        uvec4(packHalf2x16(albedo.rg), packHalf2x16(vec2(albedo.b, f0.r)), packHalf2x16(f0.gb), point.first ? 1u : 0u),
        uvec4(floatBitsToUint(point.weight), floatBitsToUint(point.ray_length)));
}

Mirrored load_mirrored(usamplerBuffer points, uint index) {
    int first = 4 * int(index);
    uvec4 place = texelFetch(points, first);
    uvec4 directions = texelFetch(points, first + 1);
    uvec4 lobes = texelFetch(points, first + 2);
    vec2 middle = unpackHalf2x16(lobes.y);
    vec2 layer = unpackUnorm2x16(directions.z);
    Surface surface = Surface(
        uintBitsToFloat(place.xyz), unpack_direction(directions.x), unpack_direction(directions.y),
        vec3(unpackHalf2x16(lobes.x), middle.x), vec3(middle.y, unpackHalf2x16(lobes.z)), layer.x, layer.y);
    vec4 weight = uintBitsToFloat(texelFetch(points, first + 3));
    return Mirrored(surface, unpack_direction(directions.w), weight.xyz, place.w, weight.w, lobes.w != 0u);
}

#endif
