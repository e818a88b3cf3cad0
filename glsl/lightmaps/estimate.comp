#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/exact_sum.glsl"
#include "lightmaps/lookup.glsl"

// One texel of the approximated illumination map (AIM; Larsen & Christensen 2004, section 3) by photons: the flux of the N nearest ones of the same surface over the
// area that they span,
//
//   E ≈ Σ Φ/A        W/m²
//
// Near is by the larger of the distances along the map's axes, in whole texels: photons are listed by texels, so that those of a square are a run in each of its rows.
// A ends at the surface's edge. Where geometry cuts the square, photons and texels count that the texel sees. A surface with fewer photons takes all of them over all
// of it.
//
// While nothing changes, rounds of other photons join: a texel keeps the mean of what they say. The n-th looks for N·n^(−1/3) photons, so that noise and blur both go
// to nothing with more rounds (progressive photon mapping as Knaus & Zwicker 2011 have it, α = 2/3).

layout(local_size_x = 64) in;

layout(set = 0, binding = 1) uniform usamplerBuffer starts;     // of each texel's list
layout(set = 0, binding = 2) uniform usamplerBuffer hits;       // two texels each, as in photons.glsl, but for the last word: the light
layout(set = 0, binding = 3) uniform usamplerBuffer touched;    // 1: the surface's photons changed
layout(set = 0, binding = 4) uniform samplerBuffer areas;       // m², by texel
layout(set = 0, binding = 5) buffer Received { vec4 received[]; };   // by map; w: rounds

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint nearest;        // N
    uint all;            // 1: something moved, and texels may see other parts of their surfaces
    float steps_a_watt;
    uint own_maps;       // lights that have a map of their own, the first ones
    uint maps;
    uint rounds;         // that a texel may have, in a frame in which one joins; else 0
} push;

// Texels along each axis that are looked at, at most.
const int SAMPLES = 24;

// Texels of a map, corners included.
struct Square {
    uint first;
    int width;
    ivec2 low;
    ivec2 high;
};

uint photons_before(Square square, int y) {
    return texelFetch(starts, int(square.first) + y * square.width + square.low.x).x;
}

uint photons_until(Square square, int y) {
    return texelFetch(starts, int(square.first) + y * square.width + square.high.x + 1).x;
}

uint photons_in(Square square) {
    uint count = 0u;
    [[dont_unroll]] for (int y = square.low.y; y <= square.high.y; ++y) {
        count += photons_until(square, y) - photons_before(square, y);
    }
    return count;
}

// The least square around a texel that holds N photons, or the whole map.
Square square_around(uint first, ivec2 size, ivec2 own, uint nearest) {
    Square square = Square(first, size.x, own, own);
    int reach = 0;
    [[dont_unroll]] while (photons_in(square) < nearest && (any(greaterThan(square.low, ivec2(0))) || any(lessThan(square.high, size - 1)))) {
        reach += max(reach / 4, 1);
        square.low = max(own - reach, ivec2(0));
        square.high = min(own + reach, size - 1);
    }
    return square;
}

// The area of the surface that is nearest to a square's texels, m², and whether geometry cuts any of their cells.
struct Span {
    float area;
    bool cut;
};

Span span_of(Square square) {
    Span span = Span(0.0, false);
    [[dont_unroll]] for (int y = square.low.y; y <= square.high.y; ++y) {
        [[dont_unroll]] for (int x = square.low.x; x <= square.high.x; ++x) {
            int texel = int(square.first) + y * square.width + x;
            uint known = texelFetch(lightmap_flags, texel).x;
            float area = texelFetch(areas, texel).x;
            span.area += area;
            span.cut = span.cut || (area > 0.0 && known != TEXEL_VALID);
        }
    }
    return span;
}

// What share of it the texel sees, by some of its texels.
float seen_share(Square square, vec3 origin, uint number) {
    ivec2 stride = (square.high - square.low + SAMPLES) / SAMPLES;
    vec2 sums = vec2(0.0);
    [[dont_unroll]] for (int y = square.low.y; y <= square.high.y; y += stride.y) {
        [[dont_unroll]] for (int x = square.low.x; x <= square.high.x; x += stride.x) {
            uint other = square.first + uint(y * square.width + x);
            float area = texelFetch(areas, int(other)).x;
            bool seen = area > 0.0 && (other == number || (is_valid(other) && sees_texel(origin, load_light_texel(other))));
            sums += vec2(area, seen ? area : 0.0);
        }
    }
    return sums.y / max(sums.x, 1e-30);
}

// The flux of its photons that belongs to a map, in steps.
Sum sum_of(Square square, bool cut, LightTexel texel, vec3 origin, uint map) {
    Sum sum = NO_SUM;
    [[dont_unroll]] for (int y = square.low.y; y <= square.high.y; ++y) {
        uint end = photons_until(square, y);
        [[dont_unroll]] for (uint place = photons_before(square, y); place < end; ++place) {
            vec3 position = uintBitsToFloat(texelFetch(hits, 2 * int(place)).xyz);
            uvec4 hit = texelFetch(hits, 2 * int(place) + 1);
            if (min(hit.w, push.own_maps) == map && (!cut || !is_occluded(origin, lifted(position, texel.face, texel.size) - origin, 1.0))) {
                add(sum, uintBitsToFloat(hit.xyz) * push.steps_a_watt);
            }
        }
    }
    return sum;
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    LightTexel texel = load_light_texel(number);
    uint surface = texelFetch(lightmap_texels, 2 * int(number) + 1).w;
    float done = push.rounds > 0u ? received[number].w : 0.0;
    bool changed = push.all != 0u || texelFetch(touched, int(surface)).x != 0u;
    bool waits = push.rounds > 0u ? done < float(push.rounds) : changed;
    if (texel.triangle == NO_TEXEL || !is_valid(number) || !waits) {
        return;
    }
    Chart chart = load_chart(lightmap_charts, texel.triangle & ~TEXEL_BACK);
    uint first = first_of_side(chart, (texel.triangle & TEXEL_BACK) != 0u);
    uint nearest = uint(ceil(float(push.nearest) * pow(done + 1.0, -1.0 / 3.0)));
    Square square = square_around(first, chart.size, place_on_map(chart, first, number), nearest);
    Span span = span_of(square);
    vec3 origin = lifted(texel.position, texel.face, texel.size);
    float area = span.area * (span.cut ? seen_share(square, origin, number) : 1.0);
    [[dont_unroll]] for (uint map = 0u; map < push.maps; ++map) {
        Sum sum = sum_of(square, span.cut, texel, origin, map);
        vec3 irradiance = steps_of(sum) / (push.steps_a_watt * max(area, 1e-30));
        irradiance = is_finite(irradiance) ? irradiance : vec3(0.0);
        uint place = map * push.texel_count + number;
        received[place] = vec4(done > 0.0 ? mix(received[place].rgb, irradiance, 1.0 / (done + 1.0)) : irradiance, done + 1.0);
    }
}
