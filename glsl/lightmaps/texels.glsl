// Texels of light maps as they lie in space, two texels (rgba32ui) each:
//
//   position in the rays' space | normal of shading, packed
//   normal of the triangle, packed | size, m | triangle and TEXEL_BACK; NO_TEXEL: nobody reads it | number of the surface and side
#ifndef LIGHTMAPS_TEXELS
#define LIGHTMAPS_TEXELS

#include "groups/lightmap.glsl"
#include "lib/bvh.glsl"
#include "lib/octahedral.glsl"
#include "lib/ray_offset.glsl"
#include "lightmaps/charts.glsl"

// Of a texel: it lies in the open, not within geometry.
const uint TEXEL_VALID = 1u;
// Of the cell that begins with it: some texel lies within geometry, or does not see another one.
const uint CELL_CUT = 2u;

// Texels see each other above their surface, by this share of their size: what is lower parts no rooms.
const float LIFT = 0.05;

struct LightTexel {
    vec3 position;
    vec3 normal;
    vec3 face;
    float size;
    uint triangle;  // and side
};

LightTexel load_light_texel(uint number) {
    uvec4 place = texelFetch(lightmap_texels, 2 * int(number));
    uvec4 more = texelFetch(lightmap_texels, 2 * int(number) + 1);
    return LightTexel(
        uintBitsToFloat(place.xyz), unpack_direction(place.w), unpack_direction(more.x), uintBitsToFloat(more.y), more.z);
}

vec3 lifted(vec3 position, vec3 face, float size) {
    return offset_ray_origin(position, face) + LIFT * size * face;
}

// Whether a point of a surface, lifted, sees a texel of the same surface.
bool sees_texel(vec3 origin, LightTexel texel) {
    return !is_occluded(origin, lifted(texel.position, texel.face, texel.size) - origin, 1.0);
}

#endif
