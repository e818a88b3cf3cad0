// The light of one cache. The including file has visibility_of_group() and groups of 64 invocations.
#ifndef VOLUMES_LIGHT
#define VOLUMES_LIGHT

#include "groups/light_caches.glsl"
#include "caches/arriving.glsl"
#include "lib/sobol.glsl"
#include "lib/spherical_harmonics.glsl"
#include "lib/disc.glsl"
#include "lib/weighted_draw.glsl"
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

// Of the surfaces that ask for the cache; the box around all of them, and the mean of the ways that they face.
shared Horizon horizons[FACINGS];
shared Horizon shared_whole;
shared uint shared_count;
shared vec3 shared_facing;

// The same for one invocation: loops read shared memory no more than they must.
Horizon whole;
uint horizon_count;
vec3 facing;

// All invocations must come here.
void load_horizons(uint cache) {
    if (gl_LocalInvocationIndex == 0u) {
        uint count = 0u;
        vec3 sum = vec3(0.0);
        Horizon around = Horizon(vec3(1.0), vec3(-1.0), -3e38);
        [[dont_unroll]] for (uint index = 0u; index < FACINGS; ++index) {
            Horizon horizon;
            if (horizon_of_cache(cache, index, horizon)) {
                horizons[count++] = horizon;
                sum += 0.5 * (horizon.low + horizon.high);
                around = Horizon(min(around.low, horizon.low), max(around.high, horizon.high), max(around.height, horizon.height));
            }
        }
        shared_count = count;
        shared_whole = around;
        shared_facing = sum / max(float(count), 1.0);
    }
    barrier();
    whole = shared_whole;
    horizon_count = shared_count;
    facing = shared_facing;
}

bool is_above_one(uint index, vec3 way) {
    return index < horizon_count && is_above(horizons[index], way);
}

bool is_above_any(vec3 way) {
    bool above = is_above(whole, way);
    if (above && horizon_count > 1u) {
        // Written out: steps of loops are counted (src/diffuse/volumes/light.rs).
        above = is_above_one(0u, way) || is_above_one(1u, way) || is_above_one(2u, way) || is_above_one(3u, way) || is_above_one(4u, way) || is_above_one(5u, way);
    }
    return above;
}

struct Sums {
    mat3x4 low;    // a column for red, green, blue
    mat3x4 high;
    vec3 last;
};

// Φ/π · |F|, and the unit vector along F.
vec3 light_from(Vpl light, vec3 position_rs, out vec3 direction) {
    if (PAPER != 0u) {
        return point_light_from(light, position_rs, direction);
    }
    Vpl disc = as_disc(light);
    vec3 factor = disc_vector(disc, position_rs, facing);
    float size = length(factor);
    direction = factor / max(size, 1e-30);
    return disc.strength * size;
}

// What a light gives, about. From behind it, and from below all surfaces that ask for the cache, nothing comes.
float about_given(Vpl light, vec3 position_rs) {
    vec3 direction;
    float given = max3(point_light_from(light, position_rs, direction));
    return PAPER != 0u || (given > 0.0 && is_above_any(light.position_rs - position_rs)) ? given : 0.0;
}

// The first lights of a group that give the cache something are known by a bit each.
const int KNOWN_LIGHTS = 32;

struct Target {
    int light;   // -1: none gives anything
    uint gives;
};

// One light of a group, drawn by what each gives, so that Σ_i E_i V_i of lights that are hidden in part is met in the mean. The number that it is drawn by is the group's:
// neighbouring caches send their rays to the same light, and nothing flickers between them.
Target target_of(LightGroup group, uint number, vec3 position_rs) {
    WeightedDraw draw = start_draw(mix_bits(number));
    uint gives = 0u;
    for (int index = group.first; index < group.end; ++index) {
        float given = about_given(load_area_light(index), position_rs);
        if (given > 0.0) {
            offer(draw, index, given);
            gives |= index - group.first < KNOWN_LIGHTS ? 1u << (index - group.first) : 0u;
        }
    }
    return Target(draw.drawn, gives);
}

bool gives(Target target, LightGroup group, int index, vec3 position_rs) {
    int place = index - group.first;
    return place < KNOWN_LIGHTS ? (target.gives >> place & 1u) != 0u : about_given(load_area_light(index), position_rs) > 0.0;
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
    if (PAPER == 0u) {
        load_horizons(cache);
    }
    Sums sums = Sums(mat3x4(0.0), mat3x4(0.0), vec3(0.0));
    for (int index = push.first_group + int(self); index < end; index += 64) {
        LightGroup group = load_light_group(area_light_groups, index);
        Target target = target_of(group, uint(index), position_rs);
        if (target.light < 0) {
            continue;
        }
        float visibility = visibility_of_group(push.rays, group, load_area_light(target.light), position_rs);
        for (int number = group.first; number < group.end && visibility > 0.0; ++number) {
            if (gives(target, group, number, position_rs)) {
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
