#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/scene.glsl"
#include "lib/vectors.glsl"
#include "vpl/region_planes.glsl"

// The plane and the normals of one region from its four quarters of the level below (vpl/region_planes.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 1) uniform sampler2D quarter_planes;
layout(set = 0, binding = 2) uniform usampler2D quarter_normals;
layout(set = 0, binding = 3, rgba32f) writeonly uniform image2D planes;
layout(set = 0, binding = 4, rgba32ui) writeonly uniform uimage2D normals;

layout(push_constant, scalar) uniform Push {
    ivec2 size;              // regions
    float side;              // of a quarter, pixels
    float depth_threshold;   // relative to the distance
    float normal_threshold;
} push;

void main() {
    ivec2 cell = pixel_of_invocation();
    if (!is_inside(cell, push.size)) {
        return;
    }
    Square quarters[4];
    for (int i = 0; i < 4; ++i) {
        ivec2 quarter = 2 * cell + ivec2(i & 1, i >> 1);
        quarters[i] = unpack_square(texelFetch(quarter_planes, quarter, 0), texelFetch(quarter_normals, quarter, 0));
    }
    float scale = camera.depth_range > 0.0 ? length(camera.right_scaled) / camera.depth_range : 0.0;
    Square region = merged(quarters, push.side, push.depth_threshold, scale, push.normal_threshold);
    imageStore(planes, cell, region.plane);
    imageStore(normals, cell, pack_normals(region));
}
