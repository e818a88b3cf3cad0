// The light of one cache. The including file has visibility_of_group() and groups of 64 invocations.
#ifndef VOLUMES_LIGHT
#define VOLUMES_LIGHT

#include "groups/light_caches.glsl"
#include "caches/arriving.glsl"
#include "lib/spherical_harmonics.glsl"
#include "caches/rays.glsl"

// One group of invocations a cache: the light that comes to it from all virtual area lights, as spherical harmonics of two or three bands (Reich 2015, section 4.3.2),
//
//   c_lm = Σ_i V_g(i) · Φ_i/π · (n_i·−ω_i)⁺ / (d_i² + a_i) · y_lm(ω_i)        W/m²
//
// ω_i the unit vector towards light i, a_i its area in the disc form (caches/reduce.comp), V_g the visibility of the light's group. A cache's light depends on where it
// lies and on nothing else. Each invocation takes every 64th group of lights; then one invocation for each number adds up what they found, in a fixed order.
// The numbers of a cache are texels of four: of three bands red 0–3, red 4–7, green 0–3, …, blue 4–7, and the last of red, green and blue; of two bands red, green, blue.

layout(constant_id = 0) const uint BANDS = 3u;

// 1: which groups of lights each cache sees is kept, a bit each, for whoever lights the same caches.
layout(constant_id = 3) const uint KEEPS_SEEN = 0u;

layout(set = 0, binding = 0) buffer LightBlock { float light[]; };
layout(set = 0, binding = 1) coherent buffer SeenBlock { uint seen[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    int first_group;
    int end_group;
    uint capacity;
    uint seen_words;  // of a cache
} push;

const uint NUMBERS = BANDS == 3u ? 28u : 12u;

shared float found[64 * 28];

struct Sums {
    mat3x4 low;    // a column for red, green, blue
    mat3x4 high;
    vec3 last;
};

void light_cache() {
    uint self = gl_LocalInvocationIndex;
    uint cache = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (cache >= min(texelFetch(cache_head, 3).x, push.capacity)) {
        return;
    }
    int end = min(push.end_group, int(texelFetch(area_light_counts, 1).x));
    if (push.first_group > 0 && push.first_group >= end) {
        return;
    }
    uint first_word = cache * push.seen_words;
    if (KEEPS_SEEN != 0u && push.first_group == 0) {
        for (uint word = self; word < push.seen_words; word += 64u) {
            seen[first_word + word] = 0u;
        }
        memoryBarrierBuffer();
        barrier();
    }
    vec3 position_rs = position_of_cache(cache);
    Sums sums = Sums(mat3x4(0.0), mat3x4(0.0), vec3(0.0));
    for (int index = push.first_group + int(self); index < end; index += 64) {
        LightGroup group = load_light_group(area_light_groups, index);
        if (faces_any(group, position_rs)) {
            float visibility = visibility_of_group(push.rays, group, load_area_light(group.middle), position_rs);
            if (KEEPS_SEEN != 0u && visibility > 0.0) {
                atomicOr(seen[first_word + uint(index) / 32u], 1u << (uint(index) & 31u));
            }
            for (int number = group.first; number < group.end && visibility > 0.0; ++number) {
                vec3 direction;
                vec3 received = visibility * light_from(load_area_light(number), position_rs, direction);
                sums.low += outerProduct(harmonics_of_low_bands(direction), received);
                if (BANDS == 3u) {
                    sums.high += outerProduct(harmonics_of_band_2(direction), received);
                    sums.last += last_harmonic(direction) * received;
                }
            }
        }
    }
    uint first = self * NUMBERS;
    uint stride = BANDS == 3u ? 8u : 4u;
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint number = 0u; number < 4u; ++number) {
            found[first + channel * stride + number] = sums.low[channel][number];
            if (BANDS == 3u) {
                found[first + channel * stride + 4u + number] = sums.high[channel][number];
            }
        }
        if (BANDS == 3u) {
            found[first + 24u + channel] = sums.last[channel];
        }
    }
    if (BANDS == 3u) {
        found[first + 27u] = 0.0;
    }
    barrier();
    if (self < NUMBERS) {
        float sum = 0.0;
        [[dont_unroll]] for (int lane = 0; lane < 64; ++lane) {
            sum += found[uint(lane) * NUMBERS + self];
        }
        uint place = cache * NUMBERS + self;
        light[place] = push.first_group > 0 ? light[place] + sum : sum;
    }
}

#endif
