#version 460
#include "lib/prelude.glsl"
#include "lib/surface_packing.glsl"
#include "points/listed_tile.glsl"
#include "points/source.glsl"

// The slot `caustics` at one pixel of a tile: L = ρ/π · Σ_y w(y)·Φ(y)/Σ w·A over the pixels y around it on which photons fall (points/spread.comp), W/(m²·sr). All pixels
// of a tile look through the same pixels, those that some of them may be reached from: bits of the tiles around say which these are.

layout(local_size_x = 64) in;

layout(set = 0, binding = 2) uniform usamplerBuffer tile_reaches;
layout(set = 0, binding = 3) uniform usamplerBuffer tile_lit;
layout(set = 0, binding = 4) uniform usampler2D slots;
layout(set = 0, binding = 5) uniform usamplerBuffer sources;
layout(set = 0, binding = 6, rgba32f) writeonly uniform image2D caustics;

layout(push_constant, scalar) uniform Push { ivec2 size; } push;

// Bits of the columns `low` to `high` of a tile, in each of four rows.
uint columns_of(int low, int high) {
    uint row = (0xFFu >> (7 - high)) & (0xFFu << low);
    return row * 0x01010101u;
}

// Bits of those of four rows from `first` on that lie within `low` to `high`.
uint rows_of(int first, int low, int high) {
    int from = clamp(low - first, 0, 4);
    int to = clamp(high - first + 1, 0, 4);
    uint below_to = to == 4 ? 0xFFFFFFFFu : (1u << (8 * to)) - 1u;
    uint below_from = from == 4 ? 0xFFFFFFFFu : (1u << (8 * from)) - 1u;
    return below_to & ~below_from;
}

vec3 irradiance_from(ivec2 place, ivec2 pixel, Place receiver) {
    ivec2 step = pixel - place;
    uint slot = texelFetch(slots, place, 0).x;
    if (slot == 0u) {
        return vec3(0.0);
    }
    Source source = load_source(sources, slot - 1u);
    return max(abs(step.x), abs(step.y)) <= source.reach ? source.light * weight_of(source.place, source.spreading, receiver, step) : vec3(0.0);
}

void main() {
    int tile = tile_of_group(push.size);
    if (tile == NO_TILE) {
        return;
    }
    ivec2 tiles = tiles_of(push.size);
    ivec2 own = ivec2(tile % tiles.x, tile / tiles.x);
    ivec2 pixel = pixel_of_tile(tile, push.size);
    Place receiver = place_of_pixel(pixel, push.size);
    int reach = ALL_TILES != 0u && WORLD == 0u ? SCREEN_REACH : int(texelFetch(tile_reaches, tile).x) - 1;
    ivec2 low = max(TILE_SIDE * own - reach, ivec2(0));
    ivec2 high = min(TILE_SIDE * own + (TILE_SIDE - 1) + reach, push.size - 1);
    vec3 irradiance = vec3(0.0);
    [[dont_unroll]] for (int y = low.y / TILE_SIDE; y <= high.y / TILE_SIDE; ++y) {
        [[dont_unroll]] for (int x = low.x / TILE_SIDE; x <= high.x / TILE_SIDE; ++x) {
            ivec2 corner = TILE_SIDE * ivec2(x, y);
            ivec2 from = max(low - corner, ivec2(0));
            ivec2 to = min(high - corner, ivec2(TILE_SIDE - 1));
            [[dont_unroll]] for (int half_tile = 0; half_tile < 2; ++half_tile) {
                uint bits = columns_of(from.x, to.x) & rows_of(4 * half_tile, from.y, to.y);
                bits &= ALL_TILES != 0u ? 0xFFFFFFFFu : texelFetch(tile_lit, 2 * (y * tiles.x + x) + half_tile).x;
                [[dont_unroll]] while (bits != 0u) {
                    int bit = findLSB(bits);
                    bits &= bits - 1u;
                    irradiance += irradiance_from(corner + ivec2(bit & 7, 4 * half_tile + (bit >> 3)), pixel, receiver);
                }
            }
        }
    }
    if (is_inside(pixel, push.size)) {
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(receiver.position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 radiance = receiver.valid ? irradiance * indirect_diffuse_albedo(point) * INVERSE_PI : vec3(0.0);
        imageStore(caustics, pixel, vec4(radiance, 1.0));
    }
}
