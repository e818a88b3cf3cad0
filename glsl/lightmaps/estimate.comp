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

layout(local_size_x = 64) in;

layout(set = 0, binding = 1) uniform usamplerBuffer starts;     // of each texel's list
layout(set = 0, binding = 2) uniform usamplerBuffer hits;       // two texels each, as in photons.glsl
layout(set = 0, binding = 3) uniform usamplerBuffer touched;    // 1: the surface's photons changed
layout(set = 0, binding = 4) uniform samplerBuffer areas;       // m², by texel
layout(set = 0, binding = 5) buffer Received { vec4 received[]; };

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint nearest;        // N
    uint all;            // 1: something moved, and texels may see other parts of their surfaces
    float steps_a_watt;
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
Square square_around(uint first, ivec2 size, ivec2 own) {
    Square square = Square(first, size.x, own, own);
    int reach = 0;
    [[dont_unroll]] while (photons_in(square) < push.nearest && (any(greaterThan(square.low, ivec2(0))) || any(lessThan(square.high, size - 1)))) {
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

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    LightTexel texel = load_light_texel(number);
    uint surface = texelFetch(lightmap_texels, 2 * int(number) + 1).w;
    if (texel.triangle == NO_TEXEL || !is_valid(number) || (push.all == 0u && texelFetch(touched, int(surface)).x == 0u)) {
        return;
    }
    Chart chart = load_chart(lightmap_charts, texel.triangle & ~TEXEL_BACK);
    uint first = first_of_side(chart, (texel.triangle & TEXEL_BACK) != 0u);
    Square square = square_around(first, chart.size, place_on_map(chart, first, number));
    Span span = span_of(square);
    vec3 origin = lifted(texel.position, texel.face, texel.size);
    float area = span.area * (span.cut ? seen_share(square, origin, number) : 1.0);
    Sum sum = NO_SUM;
    [[dont_unroll]] for (int y = square.low.y; y <= square.high.y; ++y) {
        uint end = photons_until(square, y);
        [[dont_unroll]] for (uint place = photons_before(square, y); place < end; ++place) {
            vec3 position = uintBitsToFloat(texelFetch(hits, 2 * int(place)).xyz);
            if (!span.cut || !is_occluded(origin, lifted(position, texel.face, texel.size) - origin, 1.0)) {
                add(sum, uintBitsToFloat(texelFetch(hits, 2 * int(place) + 1).xyz) * push.steps_a_watt);
            }
        }
    }
    vec3 irradiance = steps_of(sum) / (push.steps_a_watt * max(area, 1e-30));
    received[number] = vec4(is_finite(irradiance) ? irradiance : vec3(0.0), 1.0);
}
