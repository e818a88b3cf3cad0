#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/pixels.glsl"
#include "lib/scene.glsl"
#include "lib/vectors.glsl"
#include "regions/planes.glsl"
#include "regions/regions.glsl"
#include "regions/list.glsl"

// The plane and the normals of one region from its four quarters of the level below (regions/planes.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 1) uniform sampler2D quarter_planes;
layout(set = 0, binding = 2) uniform usampler2D quarter_normals;
layout(set = 0, binding = 3, rgba32f) writeonly uniform image2D planes;
layout(set = 0, binding = 4, rgba32ui) writeonly uniform uimage2D normals;

layout(push_constant, scalar) uniform Push {
    ivec2 size;              // pixels
    int level;
    int level_count;
    float depth_threshold;   // relative to the distance
    float normal_threshold;
    float slope_threshold;   // change of depth over the region, relative to the distance
} push;

Square square_of_region(ivec2 cell) {
    if (!is_inside(cell, size_of_level(push.size, push.level - 1))) {
        return Square(vec4(0.0), vec3(0.0), vec3(0.0));
    }
    return unpack_square(texelFetch(quarter_planes, cell, 0), texelFetch(quarter_normals, cell, 0));
}

void main() {
    ivec2 cell = pixel_of_invocation();
    Square quarters[4];
    for (int i = 0; i < 4; ++i) {
        quarters[i] = square_of_region(2 * cell + ivec2(i & 1, i >> 1));
    }
    float side = float(1 << (push.level - 1));
    Square region = merged(quarters, side, push.depth_threshold, unit_of_depth(camera), push.normal_threshold, push.slope_threshold);
    if (is_inside(cell, size_of_level(push.size, push.level))) {
        imageStore(planes, cell, region.plane);
        imageStore(normals, cell, pack_normals(region));
    }
    if (LISTS != 0u) {
        append_regions(valid_regions(quarters, region, push.level_count == push.level + 1), push.size, push.level, cell);
    }
}
