#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "groups/surface.glsl"
#include "photon_splat/answer.glsl"
#include "photon_splat/fixed_point.glsl"
#include "photon_splat/lattice.glsl"
#include "photon_splat/listed_tile.glsl"

// Turns the sums of four samples of a tile that photons reach into what gather.comp gives.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer sums;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D result;

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    int downscale;
    uint list;
    ivec2 range;  // of tiles
} push;

void resolve(int tile, int which) {
    ivec2 size = lattice_size(push.image_size, push.downscale);
    ivec2 place = sample_of_tile(tile, size, which);
    if (!is_inside(place, size)) {
        return;
    }
    ivec2 pixel = pixel_of_sample(place, push.image_size, push.downscale);
    int first = 2 * (TILE_SAMPLES * (tile - push.range.x) + index_in_tile(gl_LocalInvocationIndex, which));
    uvec4 low = texelFetch(sums, first);
    uvec4 high = texelFetch(sums, first + 1);
    float scale = fixed_point_scale(uintBitsToFloat(texelFetch(splat_peaks, tile).x));
    vec3 sum = from_fixed(low.xyz, high.xyz, scale);
    if (push.downscale == 1) {
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        sum = answer(sum, texelFetch(surface, pixel, 0), lobe);
    }
    imageStore(result, place, vec4(sum, 1.0));
}

void main() {
    int tile = tile_in_range(listed_tile(splat_state, splat_tiles, push.list), push.range);
    if (tile != NO_TILE) {
        [[dont_unroll]] for (int which = 0; which < 4; ++which) {
            resolve(tile, which);
        }
    }
}
