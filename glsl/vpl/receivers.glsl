// The receiver of a region: the surface at the pixel right below its centre, with the middle of its normals. The region's plane, carried there from
// one corner, would be off the surface by its tolerance, and rays from behind a surface see nothing.

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D surface;
layout(set = 0, binding = 4) uniform usampler2D normals;

Receiver receiver_of_region(Region region, ivec2 size) {
    ivec2 pixel = min(((2 * region.cell + 1) << region.level) / 2, size - 1);
    vec3 position_rs = position_of_pixel(camera, (2.0 * vec2(pixel) + 1.0) / vec2(size) - 1.0, texelFetch(depth, pixel, 0).x);
    if (region.level == 0) {
        return Receiver(position_rs, unpack_direction(texelFetch(surface, region.cell, 0).x));
    }
    Square square = unpack_square(vec4(0.0), texelFetch(normals, region.cell, region.level - 1));
    vec3 normal = normalize_or(square.low_normal + square.high_normal, vec3(0.0, 0.0, 1.0));
    return Receiver(position_rs, normal);
}
