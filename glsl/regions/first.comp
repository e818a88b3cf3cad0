#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "regions/planes.glsl"
#include "regions/regions.glsl"
#include "regions/list.glsl"

// The plane and the normals of one region of level 1, from its 2x2 pixels (regions/planes.glsl). A pixel's plane is that of its triangle,
//
//   ∂d/∂x = d · n·r_x/(n·r)      r the ray through the pixel, r_x its change per pixel (perspective)
//   ∂d/∂x = (n·r_x)/(n·f)/range                                                        (orthographic, f forward)

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D planes;
layout(set = 0, binding = 2, rgba32ui) writeonly uniform uimage2D normals;

layout(push_constant, scalar) uniform Push {
    ivec2 size;              // pixels
    int level_count;
    float depth_threshold;   // relative to the distance
    float normal_threshold;
    float slope_threshold;   // change of depth over the region, relative to the distance
} push;

Square square_of_pixel(ivec2 pixel) {
    float pixel_depth = is_inside(pixel, push.size) ? texelFetch(depth, pixel, 0).x : 0.0;
    uvec4 packed = texelFetch(surface, min(pixel, push.size - 1), 0);
    if (!is_receiver(pixel_depth, packed)) {
        return Square(vec4(0.0), vec3(0.0), vec3(0.0));
    }
    vec3 normal = unpack_direction(packed.x);
    vec3 plane_normal = packed.x == packed.y ? normal : unpack_direction(packed.y);
    vec2 ndc = ndc_of_pixel(pixel, push.size);
    bool orthographic = camera.depth_range > 0.0;
    vec3 ray = orthographic ? camera.forward : camera.forward + ndc.x * camera.right_scaled + ndc.y * camera.down_scaled;
    float facing = dot(plane_normal, ray);
    facing = abs(facing) > 1e-6 ? facing : 1e-6;
    float scale = orthographic ? 1.0 / camera.depth_range : pixel_depth;
    vec2 slope = 2.0 / vec2(push.size) * vec2(dot(plane_normal, camera.right_scaled), dot(plane_normal, camera.down_scaled));
    return Square(vec4(pixel_depth, slope * (scale / facing), 0.0), normal, normal);
}

void main() {
    ivec2 cell = pixel_of_invocation();
    Square quarters[4];
    for (int i = 0; i < 4; ++i) {
        quarters[i] = square_of_pixel(2 * cell + ivec2(i & 1, i >> 1));
    }
    Square region = merged(quarters, 1.0, push.depth_threshold, unit_of_depth(camera), push.normal_threshold, push.slope_threshold);
    if (is_inside(cell, push.size / 2)) {
        imageStore(planes, cell, region.plane);
        imageStore(normals, cell, pack_normals(region));
    }
    if (LISTS != 0u) {
        append_regions(valid_regions(quarters, region, push.level_count == 2), push.size, 1, cell);
    }
}
