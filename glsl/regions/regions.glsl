// Regions of several sizes (Quyen 2014, section 3.2.2.2) and where things about them lie.
//
// Level l cuts the image into squares of 2^l pixels; those that the image holds in full are its regions, floor(W/2^l) × floor(H/2^l) of them.
// What is known of a region of level 1 and above is a texel of mip l − 1 of two images, made by regions/planes.glsl:
//
//   planes   rgba32f    depth d at the region's centre and its change per pixel in x and y, of the plane of one of its pixels; how far its
//                       pixels' depths are from that plane, at most. All 0 where the region is not flat.
//   normals  rgba32ui   least and greatest value of each component of its pixels' shading normals, 6 × snorm16; unused
//
// Irradiance lies in one flattened image: level 0 at its left, the others below each other at its right.
#ifndef VPL_REGIONS
#define VPL_REGIONS

#include "lib/scene.glsl"

const int MOST_LEVELS = 7;

ivec2 size_of_level(ivec2 size, int level) {
    return size >> level;
}

// Of the level's first texel in the flattened image. Level 0 takes whole blocks of 4x2 texels, which drivers skip together. As ⌊H/2^l⌋ is at
// most half of ⌊H/2^(l−1)⌋, levels do not overlap.
ivec2 place_of_level(ivec2 size, int level) {
    return level == 0 ? ivec2(0) : ivec2((size.x + 3) & ~3, size.y - (size.y >> (level - 1)));
}

struct Region {
    int level;   // −1: none
    ivec2 cell;
};

// The region of a texel of the flattened image.
Region region_at(ivec2 size, ivec2 texel, int level_count) {
    if (texel.x < ((size.x + 3) & ~3)) {
        return Region(texel.x < size.x ? 0 : -1, texel);
    }
    int level = 1;
    while (level + 1 < level_count && texel.y >= place_of_level(size, level + 1).y) {
        ++level;
    }
    ivec2 cell = texel - place_of_level(size, level);
    return Region(all(lessThan(cell, size_of_level(size, level))) ? level : -1, cell);
}

// What a difference of depths is relative to: 0, the depth itself. An orthographic camera has no distance; half the image's width takes its place.
float unit_of_depth(Camera camera) {
    return camera.depth_range > 0.0 ? length(camera.right_scaled) / camera.depth_range : 0.0;
}

bool is_flat(sampler2D planes, ivec2 size, int level, ivec2 cell) {
    return all(lessThan(cell, size_of_level(size, level))) && texelFetch(planes, cell, level - 1).x > 0.0;
}

// Whether a pixel of the G-buffer takes diffuse light: it shows a surface, and one that has an albedo (lib/surface_packing.glsl).
bool is_receiver(float pixel_depth, uvec4 pixel_surface) {
    return pixel_depth > 0.0 && (pixel_surface.z | pixel_surface.w & 0xFFFFu) != 0u;
}

// A region is valid if it is flat but the next larger one that holds it is not (alg. 3.1). `depth` and `surface` are the G-buffer's: a pixel
// that takes light is flat. So every such pixel lies in exactly one valid region.
bool is_valid(sampler2D depth, usampler2D surface, sampler2D planes, ivec2 size, Region region, int level_count) {
    if (region.level < 0 || region.level + 1 < level_count && is_flat(planes, size, region.level + 1, region.cell / 2)) {
        return false;
    }
    return region.level == 0 ? is_receiver(texelFetch(depth, region.cell, 0).x, texelFetch(surface, region.cell, 0))
                             : is_flat(planes, size, region.level, region.cell);
}

#endif
