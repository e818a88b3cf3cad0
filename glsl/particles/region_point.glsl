// The point that stands for one listed region of the picture (regions/regions.glsl): behind its centre, with the normals of the pixel beside that.
#ifndef PARTICLES_REGION_POINT
#define PARTICLES_REGION_POINT

#include "groups/surface.glsl"
#include "lib/octahedral.glsl"
#include "lib/pixels.glsl"
#include "regions/regions.glsl"

// Of the list: words before the first region.
const int REGIONS_HEADER = 4;

layout(set = 0, binding = 0) uniform usamplerBuffer regions;
layout(set = 0, binding = 1) uniform sampler2D planes;

struct RegionPoint {
    ivec2 texel;              // of the flattened image; x < 0 beyond the list's end
    vec3 position_rs;
    vec3 normal;              // of shading
    vec3 geometric_normal;
};

// Regions that one group takes, as in src/diffuse/particles/receivers.rs. gl_WorkGroupSize is 1 where a header comes before its declaration.
const uint REGIONS_PER_GROUP = 64u;

uint region_of_invocation() {
    return gl_GlobalInvocationID.y * gl_NumWorkGroups.x * REGIONS_PER_GROUP + gl_GlobalInvocationID.x;
}

RegionPoint region_point(uint index, ivec2 size, int level_count) {
    if (index >= texelFetch(regions, 3).x) {
        return RegionPoint(ivec2(-1), vec3(0.0), vec3(0.0), vec3(0.0));
    }
    uint packed = texelFetch(regions, REGIONS_HEADER + int(index)).x;
    ivec2 texel = ivec2(packed & 0xFFFFu, packed >> 16);
    Region region = region_at(size, texel, level_count);
    vec2 ndc = vec2((2 * region.cell + 1) << region.level) / vec2(size) - 1.0;
    ivec2 pixel = min(((2 * region.cell + 1) << region.level) / 2, size - 1);
    float center_depth =
        region.level == 0 ? texelFetch(depth, pixel, 0).x : texelFetch(planes, region.cell, region.level - 1).x;
    uvec4 normals = texelFetch(surface, pixel, 0);
    return RegionPoint(
        texel, position_of_pixel(camera, ndc, center_depth), unpack_direction(normals.x), unpack_direction(normals.y));
}

#endif
