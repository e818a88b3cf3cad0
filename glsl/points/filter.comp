#version 460
#include "lib/prelude.glsl"
#include "lib/surface_packing.glsl"
#include "points/listed_tile.glsl"
#include "points/filter.glsl"

// The slot `caustics` at one pixel of a tile: L = ρ/π · Σ_y w(y)·Φ(y)/Σ w·A over the pixels y around it (points/spread.comp), W/(m²·sr).

layout(local_size_x = 64) in;

layout(set = 0, binding = 2) uniform usamplerBuffer tile_reaches;
layout(set = 0, binding = 3) uniform sampler2D spread;
layout(set = 0, binding = 4) uniform usampler2D shapes;
layout(set = 0, binding = 5, rgba32f) writeonly uniform image2D caustics;

layout(push_constant, scalar) uniform Push { ivec2 size; } push;

void main() {
    int tile = tile_of_group(push.size);
    ivec2 pixel = pixel_of_tile(max(tile, 0), push.size);
    if (tile == NO_TILE || !is_inside(pixel, push.size)) {
        return;
    }
    Place receiver = place_of_pixel(pixel, push.size);
    int reach = int(texelFetch(tile_reaches, tile).x) - 1;
    if (ALL_TILES != 0u && WORLD == 0u) {
        reach = SCREEN_REACH;
    }
    vec3 irradiance = vec3(0.0);
    [[dont_unroll]] for (int j = -reach; j <= reach; ++j) {
        [[dont_unroll]] for (int i = -reach; i <= reach; ++i) {
            ivec2 place = pixel + ivec2(i, j);
            if (any(lessThan(place, ivec2(0))) || !is_inside(place, push.size)) {
                continue;
            }
            vec4 from = texelFetch(spread, place, 0);
            if (max3(from.rgb) <= 0.0) {
                continue;
            }
            Place source = place_of_pixel(place, push.size);
            if (max(abs(i), abs(j)) <= reach_of(from.a, source.extent)) {
                vec3 inverse = vec3(0.0);
                if (WORLD != 0u) {
                    uvec4 shape = texelFetch(shapes, place, 0);
                    inverse = uintBitsToFloat(shape.xyz);
                    move_within_pixel(source, place, unpackUnorm2x16(shape.w), push.size);
                }
                irradiance += from.rgb * weight_of(source, inverse, receiver, ivec2(i, j));
            }
        }
    }
    vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    Surface point = unpack_surface(receiver.position_rs, texelFetch(surface, pixel, 0), lobe);
    vec3 radiance = receiver.valid ? irradiance * indirect_diffuse_albedo(point) * INVERSE_PI : vec3(0.0);
    imageStore(caustics, pixel, vec4(radiance, 1.0));
}
