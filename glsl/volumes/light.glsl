// The light of eight caches. The including file has visibility_of_group() and groups of 64 invocations.
#ifndef VOLUMES_LIGHT
#define VOLUMES_LIGHT

#include "groups/light_caches.glsl"
#include "caches/arriving.glsl"
#include "lib/sobol.glsl"
#include "lib/spherical_harmonics.glsl"
#include "lib/disc.glsl"
#include "lib/weighted_draw.glsl"
#include "caches/rays.glsl"

// One group of invocations for eight caches: the light that comes to each from all virtual area lights, as spherical harmonics of two or three bands (Reich 2015, section 4.3.2),
//
//   c_lm = Σ_g V_g Σ_{i in g} Φ_i/π · |F_i| · y_lm(F_i/|F_i|)        W/m²
//
// F_i the light's vector of form factors (lib/disc.glsl), V_g the visibility of its group. The paper has (n_i·−ω_i)⁺ / (d_i² + A_i) along the unit vector ω_i towards the light. A
// cache's light depends on where it lies and on what asks for it. Eight invocations take every eighth group of lights for a cache; then what they found is added up, in a fixed order.
// Eight neighbouring invocations take the same group for eight caches: their loops are equally long, and their rays end at the same light.
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
// Invocations of a cache.
const int TURNS = 8;

shared float found[64 * 28];

// A cache, and the surfaces that ask for it.
struct Receiver {
    uint cache;
    vec3 position_rs;
    Horizon whole;  // around all surfaces
    float slope;    // what it rises by in a metre at most
    uint kinds;     // of surfaces, a bit each
    vec3 facing;    // the mean of the ways that they face
};

Receiver load_receiver(uint cache) {
    Horizon around = Horizon(vec3(1.0), vec3(-1.0), -3e38);
    uint kinds = 0u;
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint kind = 0u; kind < FACINGS && PAPER == 0u; ++kind) {
        Horizon horizon;
        if (horizon_of_cache(cache, kind, horizon)) {
            kinds |= 1u << kind;
            sum += 0.5 * (horizon.low + horizon.high);
            around = Horizon(min(around.low, horizon.low), max(around.high, horizon.high), max(around.height, horizon.height));
        }
    }
    float slope = length(max(abs(around.low), abs(around.high)));
    return Receiver(cache, position_of_cache(cache), around, slope, kinds, sum / max(float(bitCount(kinds)), 1.0));
}

bool is_above_kind(Receiver receiver, uint kind, vec3 way) {
    Horizon horizon;
    return (receiver.kinds >> kind & 1u) != 0u && horizon_of_cache(receiver.cache, kind, horizon) && is_above(horizon, way);
}

bool is_above_any(Receiver receiver, vec3 way) {
    bool above = is_above(receiver.whole, way);
    if (above && bitCount(receiver.kinds) > 1) {
        // Written out: steps of loops are counted (src/diffuse/volumes/light.rs).
        above = is_above_kind(receiver, 0u, way) || is_above_kind(receiver, 1u, way) || is_above_kind(receiver, 2u, way) ||
                is_above_kind(receiver, 3u, way) || is_above_kind(receiver, 4u, way) || is_above_kind(receiver, 5u, way);
    }
    return above;
}

// Whether any light of a group lies in front of a surface that asks for the cache; surely not, if not.
bool may_be_above(Receiver receiver, LightGroup group) {
    Horizon raised = receiver.whole;
    raised.height += receiver.slope * group.reach;
    return PAPER != 0u || is_above(raised, group.center_rs - receiver.position_rs);
}

struct Sums {
    mat3x4 low;    // a column for red, green, blue
    mat3x4 high;
    vec3 last;
};

// Φ/π · |F|, and the unit vector along F. From behind a light, and from below all surfaces that ask for the cache, nothing comes.
vec3 light_from(Vpl light, Receiver receiver, out vec3 direction) {
    if (PAPER != 0u) {
        return point_light_from(light, receiver.position_rs, direction);
    }
    vec3 way = light.position_rs - receiver.position_rs;
    direction = way;
    if (dot(light.normal, way) >= 0.0 || !is_above_any(receiver, way)) {
        return vec3(0.0);
    }
    Vpl disc = as_disc(light);
    vec3 factor = disc_vector(disc, receiver.position_rs, receiver.facing);
    float size = length(factor);
    direction = factor / max(size, 1e-30);
    return disc.strength * size;
}

// What a group of lights sends to the cache, were it seen, and one of its lights, drawn by what each gives: Σ_i E_i V_i of lights that are hidden in part is met in the mean. The
// number that it is drawn by is the group's: neighbouring caches send their rays to the same light, and nothing flickers between them. -1: no light gives anything.
int light_of_group(LightGroup group, uint number, Receiver receiver, out Sums sums) {
    sums = Sums(mat3x4(0.0), mat3x4(0.0), vec3(0.0));
    WeightedDraw draw = start_draw(mix_bits(number));
    for (int index = group.first; index < group.end; ++index) {
        vec3 direction;
        vec3 received = light_from(load_area_light(index), receiver, direction);
        float most = max3(received);
        if (most > 0.0) {
            offer(draw, index, most);
            sums.low += outerProduct(harmonics_of_low_bands(direction), received);
            if (BANDS == 3u) {
                sums.high += outerProduct(harmonics_of_band_2(direction), received);
                sums.last += last_harmonic(direction) * received;
            }
        }
    }
    return draw.drawn;
}

void keep_sums(uint first, Sums sums) {
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
}

void light_caches() {
    uint self = gl_LocalInvocationIndex;
    uint first = GROUP_CACHES * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    uint count = min(texelFetch(cache_head, 3).x, push.capacity);
    int end = min(push.end_group, int(texelFetch(area_light_counts, 1).x));
    if (first >= count || push.adds != 0u && push.first_group >= end) {
        return;
    }
    // Beyond the last cache invocations do its work once more, and leave it.
    Receiver receiver = load_receiver(min(first + self % GROUP_CACHES, count - 1u));
    Sums sums = Sums(mat3x4(0.0), mat3x4(0.0), vec3(0.0));
    for (int index = push.first_group + int(self / GROUP_CACHES); index < end; index += TURNS) {
        LightGroup group = load_light_group(area_light_groups, index);
        if (!may_be_above(receiver, group)) {
            continue;
        }
        Sums given;
        int target = light_of_group(group, uint(index), receiver, given);
        if (target >= 0) {
            float visibility = visibility_of_group(push.rays, group, load_area_light(target), receiver.position_rs);
            sums.low += visibility * given.low;
            if (BANDS == 3u) {
                sums.high += visibility * given.high;
                sums.last += visibility * given.last;
            }
        }
    }
    keep_sums(self * NUMBERS, sums);
    barrier();
    uint numbers = min(count - first, GROUP_CACHES) * NUMBERS;
    [[dont_unroll]] for (uint number = self; number < numbers; number += 64u) {
        float sum = 0.0;
        [[dont_unroll]] for (int turn = 0; turn < TURNS; ++turn) {
            sum += found[uint(turn) * GROUP_CACHES * NUMBERS + number];
        }
        uint place = first * NUMBERS + number;
        light[place] = push.adds != 0u ? light[place] + sum : sum;
    }
}

#endif
