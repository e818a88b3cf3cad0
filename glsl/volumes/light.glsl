// The light of one cache. The including file has visibility_of_group() and groups of 64 invocations.
#ifndef VOLUMES_LIGHT
#define VOLUMES_LIGHT

#include "groups/light_caches.glsl"
#include "caches/arriving.glsl"
#include "lib/sobol.glsl"
#include "lib/spherical_harmonics.glsl"
#include "lib/disc.glsl"
#include "lib/weighted_draw.glsl"
#include "lib/color.glsl"
#include "caches/light_nodes.glsl"
#include "caches/rays.glsl"
#include "volumes/numbers.glsl"

// One group of invocations a cache: the light that comes to it from all virtual area lights, as spherical harmonics of two or three bands (Reich 2015, section 4.3.2),
//
//   c_lm = Σ_i V_g(i) · Φ_i/π · |F_i| · y_lm(F_i/|F_i|)        W/m²
//
// F_i the light's vector of form factors (lib/disc.glsl), V_g the visibility of its group. The paper has (n_i·−ω_i)⁺ / (d_i² + A_i) along the unit vector ω_i towards the light. A
// cache's light depends on where it lies and on what asks for it. Each invocation takes every 64th group of lights; then one invocation for each number (volumes/numbers.glsl) adds up
// what they found, in a fixed order.
//
// `together`: neighbouring groups share a visibility where the cache sees them under an aperture that is small enough: adaptive shadow LOD, as the thesis' section 6.3 names it. Of 64
// neighbouring groups, which are at work at the same time, those of one node of the largest level that is small enough draw one light, by what each gives to the cache, and whoever of the invocations is
// free sends its ray or its cone.

// 1: the paper's lights, from all around.
layout(constant_id = 3) const uint PAPER = 0u;
// 1: caches are those of a list.
layout(constant_id = 4) const uint LISTED = 0u;
// 1: groups are taken together.
layout(constant_id = 6) const uint TOGETHER = 0u;

layout(set = 0, binding = 0) buffer LightBlock { float light[]; };
layout(set = 0, binding = 1) buffer SentBlock { uint sent[]; };      // rays or cones, of each pass
layout(set = 0, binding = 2) readonly buffer DueBlock { uint due[]; };  // volumes/carry.comp
layout(set = 0, binding = 3) uniform samplerBuffer light_nodes;      // caches/light_nodes.glsl

layout(push_constant, scalar) uniform Push {
    CacheRays rays;
    int first_group;
    int end_group;
    uint capacity;
    uint adds;        // 1: to what the cache holds
    int group_count;  // that there is room for
    float aperture;   // the sine of half of it
    uint number;      // of the pass
} push;

const uint NUMBERS = 4u * uint(TEXELS);

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

shared uint shared_sent;

struct Sums {
    mat3x4 low;    // a column for red, green, blue
    mat3x4 high;
    vec3 last;
    vec4 grey_low;  // of the luminance
    vec4 grey_high;
    float grey_last;
};

void add(inout Sums sums, vec3 direction, vec3 received) {
    float grey = luminance(received);
    vec4 low = harmonics_of_low_bands(direction);
    sums.low += outerProduct(low, received);
    sums.grey_low += grey * low;
    if (BANDS == 3u) {
        vec4 high = harmonics_of_band_2(direction);
        float last = last_harmonic(direction);
        sums.high += outerProduct(high, received);
        sums.last += last * received;
        sums.grey_high += grey * high;
        sums.grey_last += grey * last;
    }
}

// What is not kept the compiler drops.
void put(uint first, Sums sums) {
    if (CHROMA == 1u) {
        for (uint channel = 0u; channel < 3u; ++channel) {
            found[first + channel] = sums.low[channel].x;
            found[first + 4u + channel] = sums.grey_low[channel + 1u];
        }
        found[first + 3u] = BANDS == 3u ? sums.grey_last : 0.0;
        found[first + 7u] = 0.0;
    } else {
        uint stride = CHROMA == 3u ? 8u : 4u;
        for (uint channel = 0u; channel < 3u; ++channel) {
            for (uint number = 0u; number < 4u; ++number) {
                found[first + channel * stride + number] = sums.low[channel][number];
                if (CHROMA == 3u) {
                    found[first + channel * stride + 4u + number] = sums.high[channel][number];
                }
            }
        }
    }
    if (CHROMA == 3u) {
        for (uint channel = 0u; channel < 3u; ++channel) {
            found[first + 24u + channel] = sums.last[channel];
        }
        found[first + 27u] = 0.0;
    } else if (BANDS == 3u) {
        uint high = CHROMA == 2u ? 12u : 8u;
        for (uint number = 0u; number < 4u; ++number) {
            found[first + high + number] = sums.grey_high[number];
            if (CHROMA == 2u) {
                found[first + 16u + number] = number == 0u ? sums.grey_last : 0.0;
            }
        }
    }
}

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
    int light;    // -1: none gives anything
    float given;  // by all of the group
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
    return Target(draw.drawn, draw.sum, gives);
}

bool gives(Target target, LightGroup group, int index, vec3 position_rs) {
    int place = index - group.first;
    return place < KNOWN_LIGHTS ? (target.gives >> place & 1u) != 0u : about_given(load_area_light(index), position_rs) > 0.0;
}

// What the lights of a group that is seen so well give.
void add_group(inout Sums sums, Target target, LightGroup group, float visibility, vec3 position_rs) {
    for (int number = group.first; number < group.end && visibility > 0.0; ++number) {
        if (gives(target, group, number, position_rs)) {
            vec3 direction;
            vec3 received = visibility * light_from(load_area_light(number), position_rs, direction);
            add(sums, direction, received);
        }
    }
}

// Every 64th group, each with a visibility of its own; returns how many were asked for.
uint add_groups(inout Sums sums, int end, vec3 position_rs) {
    uint asked = 0u;
    for (int index = push.first_group + int(gl_LocalInvocationIndex); index < end; index += 64) {
        LightGroup group = load_light_group(area_light_groups, index);
        Target target = target_of(group, uint(index), position_rs);
        if (target.light >= 0) {
            ++asked;
            float visibility = visibility_of_group(push.rays, group, load_area_light(target.light), position_rs);
            add_group(sums, target, group, visibility, position_rs);
        }
    }
    return asked;
}

#include "volumes/together.glsl"

// The cache that the invocations work for, and how many there are.
uint cache_of_group(out uint count) {
    uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint caches = min(texelFetch(cache_head, 3).x, push.capacity);
    if (LISTED == 0u) {
        count = caches;
        return number;
    }
    count = min(due[3], caches);
    return number < count ? due[4u + number] : 0u;
}

void light_cache() {
    uint self = gl_LocalInvocationIndex;
    uint count;
    uint cache = cache_of_group(count);
    if (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x >= count) {
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
    if (self == 0u) {
        shared_sent = 0u;
    }
    Sums sums = Sums(mat3x4(0.0), mat3x4(0.0), vec3(0.0), vec4(0.0), vec4(0.0), 0.0);
    uint asked = TOGETHER != 0u ? add_nodes(sums, end, position_rs) : add_groups(sums, end, position_rs);
    put(self * NUMBERS, sums);
    barrier();
    if (asked > 0u) {
        atomicAdd(shared_sent, asked);
    }
    if (self < NUMBERS) {
        float sum = 0.0;
        [[dont_unroll]] for (int lane = 0; lane < 64; ++lane) {
            sum += found[uint(lane) * NUMBERS + self];
        }
        uint place = cache * NUMBERS + self;
        light[place] = push.adds != 0u ? light[place] + sum : sum;
    }
    barrier();
    if (self == 0u && shared_sent > 0u) {
        atomicAdd(sent[push.number], shared_sent);
    }
}

#endif
