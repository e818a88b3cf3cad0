// The receiver of a region: the point of its plane behind its centre, with the middle of its normals. The region of one pixel has the
// pixel's own. Rays start on the surface at the pixel beside the centre: the plane, carried there from one corner, may lie behind it.

#include "groups/surface.glsl"

layout(set = 0, binding = 0) uniform sampler2D planes;
layout(set = 0, binding = 1) uniform usampler2D normals;

Receiver receiver_of_region(Region region, ivec2 size) {
    // Of the region's centre.
    vec2 ndc = vec2((2 * region.cell + 1) << region.level) / vec2(size) - 1.0;
    if (region.level == 0) {
        vec3 position_rs = position_of_pixel(camera, ndc, texelFetch(depth, region.cell, 0).x);
        return Receiver(position_rs, unpack_direction(texelFetch(surface, region.cell, 0).x));
    }
    ivec2 pixel = min(((2 * region.cell + 1) << region.level) / 2, size - 1);
    float center_depth = texelFetch(planes, region.cell, region.level - 1).x;
    if (VISIBILITY == VISIBILITY_TRACED) {
        ndc = (2.0 * vec2(pixel) + 1.0) / vec2(size) - 1.0;
        center_depth = texelFetch(depth, pixel, 0).x;
    }
    Square square = unpack_square(vec4(center_depth), texelFetch(normals, region.cell, region.level - 1));
    vec3 normal = normalize_or(square.low_normal + square.high_normal, vec3(0.0, 0.0, 1.0));
    return Receiver(position_of_pixel(camera, ndc, center_depth), normal);
}
