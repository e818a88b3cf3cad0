#version 460
#include "lib/prelude.glsl"
#include "points/fixed_point.glsl"
#include "points/landing_place.glsl"
#include "points/tiles.glsl"
#include "points/width.glsl"

// Draws one photon as a point (Larsen & Christensen 2004, section 5): adds its flux Φ to the pixel that it falls on, and lists the tiles that the filter spreads it to.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) uniform usamplerBuffer fluxes;
layout(set = 0, binding = 2, r32ui) uniform uimage2D red;
layout(set = 0, binding = 3, r32ui) uniform uimage2D green;
layout(set = 0, binding = 4, r32ui) uniform uimage2D blue;
layout(set = 0, binding = 5) buffer ReachBlock { uint tile_reaches[]; };
layout(set = 0, binding = 6) writeonly buffer ListBlock { uint tile_list[]; };
layout(set = 0, binding = 7) buffer HeadBlock { uint tile_head[]; };
layout(set = 0, binding = 8) buffer LitBlock { uint tile_lit[]; };

layout(push_constant, scalar) uniform Push {
    ivec2 size;
    uint count;
    uint count_log2;
    float radius;        // of all photons, m; 0: each has its own ellipse
    float radius_scale;  // of its radii
} push;

// The larger radius that the photons of a pixel have in the mean, at most, if this one is the widest by that measure: whole numbers may be off by 1 in each of the sums of
// widths.comp, so that of a photon of f wholes whose squared radius is the share s of the largest one, (f·s + 4)/(f − 1) of it may be read.
float rounded_radius(float radius, float wholes, float extent) {
    float most = float(MOST_REACH) * extent;
    float share = wholes > 1.0 ? (wholes * radius * radius / (most * most) + 4.0) / (wholes - 1.0) : 1.0;
    return most * sqrt(min(share, 1.0));
}

void list_tiles(ivec2 pixel, int reach) {
    ivec2 low = max(pixel - reach, ivec2(0)) / TILE_SIDE;
    ivec2 high = min(pixel + reach, push.size - 1) / TILE_SIDE;
    int columns = tiles_of(push.size).x;
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            int tile = y * columns + x;
            if (atomicMax(tile_reaches[tile], uint(reach + 1)) == 0u) {
                uint listed = atomicAdd(tile_head[3], 1u);
                tile_list[listed] = uint(tile);
                atomicMax(tile_head[0], min(listed + 1u, LISTED_A_ROW));
                atomicMax(tile_head[1], listed / LISTED_A_ROW + 1u);
                atomicMax(tile_head[2], 1u);
            }
        }
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.count || max3(flux_of_kept(photons, index)) <= 0.0) {
        return;
    }
    KeptPhoton photon = load_kept(photons, index);
    ivec2 pixel;
    Place place;
    if (!lands_in_view(photon, push.size, pixel, place)) {
        return;
    }
    float scale = fixed_point_scale(fluxes, push.count_log2);
    uvec3 terms = fixed_point(photon.flux, scale, chance_of(photon.position_rs));
    imageAtomicAdd(red, pixel, terms.x);
    imageAtomicAdd(green, pixel, terms.y);
    imageAtomicAdd(blue, pixel, terms.z);
    int bit = bit_in_tile(pixel);
    atomicOr(tile_lit[2 * tile_of_pixel(pixel, push.size) + (bit >> 5)], 1u << (bit & 31));
    float radius = bounded_radius(push.radius > 0.0 ? push.radius : push.radius_scale * photon.larger, place.extent);
    float mean = (photon.flux.x + photon.flux.y + photon.flux.z) * (1.0 / 3.0);
    // Floats round too.
    list_tiles(pixel, reach_of(1.001 * rounded_radius(radius, mean * scale, place.extent), place.extent));
}
