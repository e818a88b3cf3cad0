#version 460
#include "lib/prelude.glsl"
#include "groups/light_caches.glsl"
#include "caches/asking.glsl"
#include "caches/asks.glsl"
#include "lib/color.glsl"
#include "lib/pixels.glsl"
#include "lib/vectors.glsl"
#include "radiance_maps/horizon.glsl"

// One invocation a pixel: the caches around a surface with a specular lobe get maps. Where none is in view there are none, and what follows has no groups. Whoever takes a
// cache's word from 0 by compare-and-swap gives it the map's number plus one; words 0 to 2 of `map_head` are groups of one map each, word 3 counts the maps, also those for
// which there is no room.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer SlotBlock { uint slots[]; };
layout(set = 0, binding = 1) buffer HeadBlock { uint map_head[]; };
layout(set = 0, binding = 2) writeonly buffer ListBlock { uint map_caches[]; };

layout(set = 0, binding = 3) buffer HorizonBlock { uint horizons[]; };  // radiance_maps/horizon.glsl

layout(push_constant, scalar) uniform Push {
    uint cache_capacity;
    uint capacity;
} push;

// The caches' horizons take the same bits from every frame.
void narrow_horizon(uint cache, int cascade, vec3 position_rs, uint packed_normal) {
    vec3 normal = unpack_direction(packed_normal);
    precise float before = dot(normal, position_rs - position_of_cache(cache)) / cell_of_cascade(cascades, cascade);
    bool away = dot(normal, direction_to_eye(camera, position_rs)) <= 0.0;
    uvec3 words = away ? uvec3(0xFFFFFFFFu) : uvec3(~packed_normal, packed_normal, horizon_word(cascade, before));
    for (uint word = 0u; word < 3u; ++word) {
        if (horizons[3u * cache + word] < words[word]) {
            atomicMax(horizons[3u * cache + word], words[word]);
        }
    }
}

void give_map(uint cache) {
    if (slots[cache] != 0u || atomicCompSwap(slots[cache], 0u, LOCKED) != 0u) {
        return;
    }
    uint index = atomicAdd(map_head[3], 1u);
    atomicMax(map_head[0], min(index + 1u, ROW_GROUPS));
    atomicMax(map_head[1], index / ROW_GROUPS + 1u);
    atomicMax(map_head[2], 1u);
    if (index < push.capacity) {
        map_caches[index] = cache;
        atomicExchange(slots[cache], index + 1u);
    }
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = textureSize(depth, 0);
    Asking asking = asking_of_pixel(cascades, pixel, size);
    vec4 lobe = asking.asks && HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    if (max(max3(lobe.rgb), lobe.a) <= 0.0) {
        return;
    }
    uint packed_normal = texelFetch(surface, pixel, 0).y;
    int steps = asking.in_both ? 2 : 1;
    [[dont_unroll]] for (int step = 0; step < steps; ++step) {
        Place place = place_in(cascades, asking.cascade + step, asking.position_rs);
        uint lowest = address_of(cascades, place.cascade, place.lowest);
        [[dont_unroll]] for (int corner = 0; corner < 8; ++corner) {
            uint cache = texelFetch(cache_addresses, int(lowest + corner_offset(cascades.resolution, corner))).x - 1u;
            if (cache < push.cache_capacity) {
                give_map(cache);
                narrow_horizon(cache, place.cascade, asking.position_rs, packed_normal);
            }
        }
    }
}
