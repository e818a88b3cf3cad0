// Levels of the map that a group of invocations works for. The including file has all maps as `vec4 maps[]`.
#ifndef RADIANCE_MAPS_LEVELS
#define RADIANCE_MAPS_LEVELS

#include "radiance_maps/map.glsl"

// All invocations of the group must come here.
void finish_level() {
    memoryBarrierBuffer();
    barrier();
}

// Where the map begins.
uint first_texel;

vec4 texel_at(int level, ivec2 place) {
    int side = side_of_level(level);
    ivec2 texel = clamp(place, ivec2(0), ivec2(side - 1));
    return maps[first_texel + uint(first_of_level(level) + texel.y * side + texel.x)];
}

// Each level above the finest is the sum of the one below it. All invocations of the group must come here.
void sum_levels() {
    [[dont_unroll]] for (int level = 1; level < MAP_LEVELS; ++level) {
        int side = side_of_level(level);
        for (int texel = int(gl_LocalInvocationIndex); texel < side * side; texel += 64) {
            ivec2 finer = 2 * ivec2(texel % side, texel / side);
            vec4 sum = texel_at(level - 1, finer) + texel_at(level - 1, finer + ivec2(1, 0)) +
                       texel_at(level - 1, finer + ivec2(0, 1)) + texel_at(level - 1, finer + 1);
            maps[first_texel + uint(first_of_level(level) + texel)] = sum;
        }
        finish_level();
    }
}

#endif
