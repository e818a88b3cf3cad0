// The light of one cache. The including file has visibility_of_group() and groups of 64 invocations.
#ifndef VOLUMES_LIGHT
#define VOLUMES_LIGHT

#include "groups/area_lights.glsl"
#include "groups/light_caches.glsl"
#include "caches/light_groups.glsl"
#include "lib/sobol.glsl"
#include "lib/spherical_harmonics.glsl"
#include "lib/disc.glsl"
#include "caches/rays.glsl"

// One group of invocations a cache: the light that comes to it from all virtual area lights, as spherical harmonics of two or three bands (Reich 2015, section 4.3.2),
//
//   c_lm = Σ_i V_g(i) · Φ_i/π · |F_i| · y_lm(F_i/|F_i|)        W/m²
//
// F_i the light's vector of form factors (lib/disc.glsl), V_g the visibility of its group. The paper has (n_i·−ω_i)⁺ / (d_i² + A_i) along the unit vector ω_i towards the light. A
// cache's light depends on where it lies and on what asks for it. Each invocation takes every 64th group of lights; then one invocation for each number adds up what they found, in a fixed order.
// The numbers of a cache are texels of four: of three bands red 0–3, red 4–7, green 0–3, …, blue 4–7, and the last of red, green and blue; of two bands red, green, blue.

layout(constant_id = 0) const uint BANDS = 3u;
// 1: the paper's lights, from all around.
layout(constant_id = 3) const uint PAPER = 0u;

layout(set = 0, binding = 0) buffer LightBlock { float light[]; };

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    int first_group;
    int end_group;
    uint capacity;
    uint adds;  // 1: to what the cache holds
} push;

const uint NUMBERS = BANDS == 3u ? 28u : 12u;

shared float found[64 * 28];

// Of the surfaces that ask for the cache, and the mean of the ways that they face.
shared Horizon horizons[FACINGS];
shared uint horizon_count;
shared vec3 facing;

// All invocations must come here.
void load_horizons(uint cache) {
    if (gl_LocalInvocationIndex == 0u) {
        uint count = 0u;
        vec3 sum = vec3(0.0);
        [[dont_unroll]] for (uint index = 0u; index < FACINGS; ++index) {
            Horizon horizon;
            if (horizon_of_cache(cache, index, horizon)) {
                horizons[count++] = horizon;
                sum += 0.5 * (horizon.low + horizon.high);
            }
        }
        horizon_count = count;
        facing = sum / max(float(count), 1.0);
    }
    barrier();
}

bool is_above_any(vec3 way) {
    bool above = false;
    for (uint index = 0u; index < horizon_count && !above; ++index) {
        above = is_above(horizons[index], way);
    }
    return above;
}

struct Sums {
    mat3x4 low;    // a column for red, green, blue
    mat3x4 high;
    vec3 last;
};

Vpl load_area_light(int index) {
    return unpack_vpl(texelFetch(area_lights, 2 * index), texelFetch(area_lights, 2 * index + 1));
}

// Φ/π · |F|, and the unit vector along F. From below all surfaces that ask for the cache nothing comes.
vec3 light_from(Vpl light, vec3 position_rs, out vec3 direction) {
    vec3 factor = vec3(0.0);
    if (PAPER != 0u) {
        vec3 difference = light.position_rs - position_rs;
        float squared = dot(difference, difference) + 1e-20;
        float cosine = max(-dot(light.normal, difference) * inversesqrt(squared), 0.0);
        factor = difference * (inversesqrt(squared) * cosine / (squared + light.area_over_pi));
    } else if (is_above_any(light.position_rs - position_rs)) {
        factor = disc_vector(as_disc(light), position_rs, facing);
    }
    float size = length(factor);
    direction = factor / max(size, 1e-30);
    return (PAPER != 0u ? light.strength : as_disc(light).strength) * size;
}

// One light of a group, drawn by what each gives, so that Σ_i E_i V_i of lights that are hidden in part is met in the mean; -1 if none gives anything. The number that it
// is drawn by is the group's: neighbouring caches send their rays to the same light, and nothing flickers between them.
int target_of(LightGroup group, uint number, vec3 position_rs) {
    float random = float(mix_bits(number) >> 8) / 16777216.0;
    float sum = 0.0;
    int target = -1;
    for (int index = group.first; index < group.end; ++index) {
        vec3 direction;
        float given = max3(light_from(load_area_light(index), position_rs, direction));
        if (given > 0.0) {
            sum += given;
            float chance = given / sum;
            bool taken = random < chance;
            random = taken ? random / chance : (random - chance) / max(1.0 - chance, 1e-7);
            target = taken ? index : target;
        }
    }
    return target;
}

void light_cache() {
    uint self = gl_LocalInvocationIndex;
    uint cache = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (cache >= min(texelFetch(cache_head, 3).x, push.capacity)) {
        return;
    }
    int end = min(push.end_group, int(texelFetch(area_light_counts, 1).x));
    if (push.adds != 0u && push.first_group >= end) {
        return;
    }
    vec3 position_rs = position_of_cache(cache);
    load_horizons(cache);
    Sums sums = Sums(mat3x4(0.0), mat3x4(0.0), vec3(0.0));
    for (int index = push.first_group + int(self); index < end; index += 64) {
        LightGroup group = load_light_group(area_light_groups, index);
        int target = target_of(group, uint(index), position_rs);
        if (target >= 0) {
            float visibility = visibility_of_group(push.rays, group, load_area_light(target), position_rs);
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
        light[place] = push.adds != 0u ? light[place] + sum : sum;
    }
}

#endif
