// The light of eight caches. The including file has visibility_of_group() and groups of 64 invocations.
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

// One group of invocations for eight caches: the light that comes to each from all virtual area lights, as spherical harmonics of two or three bands (Reich 2015, section 4.3.2),
//
//   c_lm = Σ_g V_g Σ_{i in g} Φ_i/π · |F_i| · y_lm(F_i/|F_i|)        W/m²
//
// F_i the light's vector of form factors (lib/disc.glsl), V_g the visibility of its group. The paper has (n_i·−ω_i)⁺ / (d_i² + A_i) along the unit vector ω_i towards the light. A
// cache's light depends on where it lies and on what asks for it. Eight invocations take every eighth group of lights for a cache; then what they found (volumes/numbers.glsl) is added up,
// in a fixed order. Eight neighbouring invocations take the same group for eight caches: their loops are equally long, and their rays end at the same light.
//
// `together`: neighbouring groups share a visibility where the cache sees them under an aperture that is small enough: adaptive shadow LOD, as the thesis' section 6.3 names it. All invocations
// go through the eight caches one after the other. Of 64 neighbouring groups, which are at work at the same time, those of one node of the largest level that is small enough draw one
// light, by what each gives to the cache, and whoever of the invocations is free sends its ray or its cone (volumes/together.glsl).

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

shared uint shared_sent;

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
    vec4 grey_low;  // of the luminance
    vec4 grey_high;
    float grey_last;
};

const Sums NOTHING = Sums(mat3x4(0.0), mat3x4(0.0), vec3(0.0), vec4(0.0), vec4(0.0), 0.0);

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

// Rounded before it is added to anything: together and apart sums have the same bits.
Sums share_of(float share, Sums given) {
    precise mat3x4 low = share * given.low;
    precise mat3x4 high = share * given.high;
    precise vec3 last = share * given.last;
    precise vec4 grey_low = share * given.grey_low;
    precise vec4 grey_high = share * given.grey_high;
    precise float grey_last = share * given.grey_last;
    return Sums(low, high, last, grey_low, grey_high, grey_last);
}

void add_sums(inout Sums sums, Sums more) {
    sums.low += more.low;
    sums.grey_low += more.grey_low;
    if (BANDS == 3u) {
        sums.high += more.high;
        sums.last += more.last;
        sums.grey_high += more.grey_high;
        sums.grey_last += more.grey_last;
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

struct Target {
    int light;    // -1: none gives anything
    float given;  // by all of the group
    Sums sums;
};

// What a group of lights sends to the cache, were it seen, and one of its lights, drawn by what each gives: Σ_i E_i V_i of lights that are hidden in part is met in the mean. The
// number that it is drawn by is the group's: neighbouring caches send their rays to the same light, and nothing flickers between them.
Target target_of(LightGroup group, uint number, Receiver receiver) {
    Sums sums = NOTHING;
    WeightedDraw draw = start_draw(mix_bits(number));
    for (int index = group.first; index < group.end; ++index) {
        vec3 direction;
        vec3 received = light_from(load_area_light(index), receiver, direction);
        float most = max3(received);
        if (most > 0.0) {
            offer(draw, index, most);
            add(sums, direction, received);
        }
    }
    return Target(draw.drawn, draw.sum, sums);
}

// Every eighth group, each with a visibility of its own; returns how many were asked for.
uint add_groups(inout Sums sums, int end, Receiver receiver) {
    uint asked = 0u;
    for (int index = push.first_group + int(gl_LocalInvocationIndex / GROUP_CACHES); index < end; index += TURNS) {
        LightGroup group = load_light_group(area_light_groups, index);
        if (!may_be_above(receiver, group)) {
            continue;
        }
        Target target = target_of(group, uint(index), receiver);
        if (target.light >= 0) {
            ++asked;
            float visibility = visibility_of_group(push.rays, group, load_area_light(target.light), receiver.position_rs);
            add_sums(sums, share_of(visibility, target.sums));
        }
    }
    return asked;
}

#include "volumes/together.glsl"

// How many caches there are to light, and one of them.
uint cache_count() {
    uint caches = min(texelFetch(cache_head, 3).x, push.capacity);
    return LISTED != 0u ? min(due[3], caches) : caches;
}

uint cache_of(uint number) {
    return LISTED != 0u ? due[4u + number] : number;
}

// A number of a cache: what all turns have found, which lies `stride` apart from `first` on.
void keep(uint cache, uint number, uint first, uint stride) {
    float sum = 0.0;
    [[dont_unroll]] for (int turn = 0; turn < TURNS; ++turn) {
        sum += found[first + uint(turn) * stride + number];
    }
    uint place = cache * NUMBERS + number;
    light[place] = push.adds != 0u ? light[place] + sum : sum;
}

// All invocations for one cache.
uint light_together(uint cache, int end) {
    uint self = gl_LocalInvocationIndex;
    uint asked = find_nodes(end, load_receiver(cache));
    if (self < NUMBERS) {
        keep(cache, self, 0u, NUMBERS);
    }
    return asked;
}

// Eight invocations for each of `count` caches from `first` on.
uint light_apart(uint first, uint count, int end) {
    uint self = gl_LocalInvocationIndex;
    // Beyond the last cache invocations do its work once more, and leave it.
    uint own = self % GROUP_CACHES;
    Sums sums = NOTHING;
    uint asked = add_groups(sums, end, load_receiver(cache_of(first + min(own, count - 1u))));
    put(self * NUMBERS, sums);
    barrier();
    [[dont_unroll]] for (uint number = self; number < count * NUMBERS; number += 64u) {
        uint of = number / NUMBERS;
        keep(cache_of(first + of), number % NUMBERS, of * NUMBERS, GROUP_CACHES * NUMBERS);
    }
    return own < count ? asked : 0u;
}

void light_caches() {
    uint self = gl_LocalInvocationIndex;
    uint first = GROUP_CACHES * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    uint count = cache_count();
    int end = min(push.end_group, int(texelFetch(area_light_counts, 1).x));
    if (first >= count || push.adds != 0u && push.first_group >= end) {
        return;
    }
    if (self == 0u) {
        shared_sent = 0u;
    }
    barrier();
    uint here = min(count - first, GROUP_CACHES);
    uint asked = 0u;
    if (TOGETHER != 0u) {
        [[dont_unroll]] for (uint own = 0u; own < here; ++own) {
            asked += light_together(cache_of(first + own), end);
        }
    } else {
        asked = light_apart(first, here, end);
    }
    if (asked > 0u) {
        atomicAdd(shared_sent, asked);
    }
    barrier();
    if (self == 0u && shared_sent > 0u) {
        atomicAdd(sent[push.number], shared_sent);
    }
}

#endif
