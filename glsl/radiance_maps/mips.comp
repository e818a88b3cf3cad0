#version 460
#include "lib/prelude.glsl"
#include "radiance_maps/map.glsl"
#include "radiance_maps/of_map.glsl"

// One group a map: its texels in W/m² and its coarser levels (radiance_maps/map.glsl). Light that was written to a coarser level is spread over the finer ones, bilinearly,
// without loss; each level above the finest is then the sum of the one below it.
//
// `pull-push` fills texels that no light was written to in the manner of imperfect shadow maps (Ritschel et al. 2008), which is what the thesis tried (section 5.4.5): their
// nearest coarser texel with any light, of the next two levels, gives them the mean of its lit ones. The map is scaled down to the light that it had.

layout(local_size_x = 64) in;

const uint FILL_PULL_PUSH = 1u;
const uint FILL_FOOTPRINT = 2u;
// Texels have their light already (radiance_maps/search.glsl).
const uint FILL_SEARCH = 3u;
// Gaps between lights, not what is dark.
const int FILLED_LEVELS = 2;

layout(constant_id = 5) const uint FILL = FILL_FOOTPRINT;

layout(set = 0, binding = 0) uniform usamplerBuffer map_head;
layout(set = 0, binding = 1) uniform samplerBuffer map_bounds;
layout(set = 0, binding = 2) uniform usamplerBuffer sums;
layout(set = 0, binding = 3) coherent buffer MapBlock { vec4 maps[]; };

layout(push_constant, scalar) uniform Push {
    uint capacity;
} push;

#include "radiance_maps/levels.glsl"

// What a texel of the level below gets of this one's light, per texel of this one.
vec4 spread(int level, ivec2 finer) {
    ivec2 place = finer / 2;
    ivec2 beside = place + 2 * (finer & 1) - 1;
    return (9.0 * texel_at(level, place) + 3.0 * texel_at(level, ivec2(beside.x, place.y)) +
            3.0 * texel_at(level, ivec2(place.x, beside.y)) + texel_at(level, beside)) / 16.0;
}

vec3 written_light(uint map, float unit, int texel) {
    int word = 3 * (int(map) * MAP_TEXELS + texel);
    return unit * vec3(texelFetch(sums, word).x, texelFetch(sums, word + 1).x, texelFetch(sums, word + 2).x);
}

// Level by level from a coarse one down to the finest.
void write_levels(uint map, float unit) {
    [[dont_unroll]] for (int level = FILL == FILL_FOOTPRINT ? MAP_LEVELS - 1 : 0; level >= 0; --level) {
        int side = side_of_level(level);
        int first = first_of_level(level);
        for (int texel = int(gl_LocalInvocationIndex); texel < side * side; texel += 64) {
            vec3 light = written_light(map, unit, first + texel);
            // The fourth number counts texels with light.
            vec4 value = vec4(light, light.x + light.y + light.z > 0.0 ? 1.0 : 0.0);
            if (FILL == FILL_FOOTPRINT && level + 1 < MAP_LEVELS) {
                value += 0.25 * spread(level + 1, ivec2(texel % side, texel / side));
            }
            maps[first_texel + uint(first + texel)] = value;
        }
        finish_level();
    }
}

void fill_gaps() {
    vec3 before = texel_at(MAP_LEVELS - 1, ivec2(0)).rgb;
    [[dont_unroll]] for (int level = FILLED_LEVELS - 1; level >= 0; --level) {
        int side = side_of_level(level);
        float finest = float(1 << (2 * level));
        for (int texel = int(gl_LocalInvocationIndex); texel < side * side; texel += 64) {
            ivec2 place = ivec2(texel % side, texel / side);
            vec4 coarser = texel_at(level + 1, place / 2);
            if (texel_at(level, place).w == 0.0 && coarser.w > 0.0) {
                maps[first_texel + uint(first_of_level(level) + texel)] = finest / coarser.w * coarser;
            }
        }
        finish_level();
    }
    sum_levels();
    vec3 after = texel_at(MAP_LEVELS - 1, ivec2(0)).rgb;
    finish_level();
    vec3 factor = before / max(after, vec3(1e-37));
    for (uint texel = gl_LocalInvocationIndex; texel < uint(MAP_TEXELS); texel += 64u) {
        maps[first_texel + texel].rgb *= factor;
    }
}

void main() {
    uint map = map_of_group();
    if (map >= min(texelFetch(map_head, 3).x, push.capacity)) {
        return;
    }
    first_texel = map * uint(MAP_TEXELS);
    if (FILL != FILL_SEARCH) {
        float scale = scale_of_bound(texelFetch(map_bounds, int(map)).x);
        write_levels(map, scale > 0.0 ? 1.0 / scale : 0.0);
    }
    sum_levels();
    if (FILL == FILL_PULL_PUSH) {
        fill_gaps();
    }
}
