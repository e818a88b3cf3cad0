// Cells and facets: triangles are cut into n×m cells, over each of which particles are equally far apart, and cells into n×m facets, for each of which one particle
// stands, so that where a ray ends is looked up instead of searched. Rows lie along the longest edge, m of them between it and the corner across, each cut into n: a
// thin triangle takes as many as it is long. Of each side of two-sided surfaces there are as many cells. Evenly spread particles take one cell a side.
//
// Records of two words: of each triangle its first cell, and how it is cut; behind all of them how many facets and cells there are; of each cell its first facet, and
// how it is cut.
#ifndef PARTICLES_FACETS
#define PARTICLES_FACETS

const uint NO_FACET = 0xFFFFFFFFu;
const uint MOST_CUTS = 4095u;

struct Cuts {
    uint columns;
    uint rows;
    uint apex;   // the corner across the longest edge
    uint sides;  // 1 or 2
    uint width;  // of a cell (widths.glsl)
};

uint pack_cuts(Cuts cuts) {
    return cuts.columns | cuts.rows << 12 | cuts.apex << 24 | (cuts.sides - 1u) << 26 | cuts.width << 27;
}

Cuts unpack_cuts(uint word) {
    return Cuts(word & 0xFFFu, word >> 12 & 0xFFFu, word >> 24 & 3u, (word >> 26 & 1u) + 1u, word >> 27);
}

// How many parts of that length at most something is cut into that is so long and so high.
Cuts cuts_of(vec2 extent, float length, uint apex, uint sides, uint width) {
    uvec2 cuts = uvec2(clamp(ceil(extent / length), vec2(1.0), vec2(MOST_CUTS)));
    return Cuts(cuts.x, cuts.y, apex, sides, width);
}

uint parts_of(Cuts cuts) {
    return cuts.columns * cuts.rows * cuts.sides;
}

// The last of `count` records from `first` on that begins no later than with `number`.
uint record_of(usamplerBuffer records, uint first, uint count, uint number) {
    uint low = first;
    uint high = first + count;
    [[dont_unroll]] for (uint halving = 0u; halving < 32u && high - low > 1u; ++halving) {
        uint middle = (low + high) / 2u;
        if (texelFetch(records, int(middle)).x <= number) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Where a point of a triangle lies along its row and across rows, from 0 to 1; by the weights of corners 1 and 2.
vec2 along_and_across(uint apex, vec2 place) {
    vec3 weights = vec3(1.0 - place.x - place.y, place);
    float height = weights[apex];
    return vec2(weights[(apex + 1u) % 3u] / max(1.0 - height, 1e-30), height);
}

// And back.
vec2 place_at(uint apex, vec2 at) {
    vec3 weights;
    weights[apex] = at.y;
    weights[(apex + 1u) % 3u] = (1.0 - at.y) * at.x;
    weights[(apex + 2u) % 3u] = (1.0 - at.y) * (1.0 - at.x);
    return weights.yz;
}

// The part in which something lies; `at`: where in the whole, then where in the part.
uint part_at(Cuts cuts, bool back, inout vec2 at) {
    vec2 count = vec2(cuts.columns, cuts.rows);
    uvec2 part = min(uvec2(clamp(at, 0.0, 1.0) * count), uvec2(cuts.columns, cuts.rows) - 1u);
    at = at * count - vec2(part);
    return ((back ? cuts.rows : 0u) + part.y) * cuts.columns + part.x;
}

// A part of a triangle: from where to where along its rows, and across them.
struct Span {
    vec2 along;
    vec2 across;
};

const Span WHOLE = Span(vec2(0.0, 1.0), vec2(0.0, 1.0));

// The part of that number of something.
Span part_of(Span whole, Cuts cuts, uint number) {
    vec2 column = vec2(number % cuts.columns) + vec2(0.0, 1.0);
    vec2 row = vec2(number / cuts.columns % cuts.rows) + vec2(0.0, 1.0);
    return Span(mix(whole.along.xx, whole.along.yy, column / float(cuts.columns)), mix(whole.across.xx, whole.across.yy, row / float(cuts.rows)));
}

// Weights of corners 1 and 2 of a point of it; `at`: along the row and across, from 0 to 1.
vec2 place_in(Span span, uint apex, vec2 at) {
    return place_at(apex, vec2(mix(span.along.x, span.along.y, at.x), mix(span.across.x, span.across.y, at.y)));
}

// Its share of the triangle's area.
float share_of(Span span) {
    vec2 widths = 1.0 - span.across;
    return (widths.x * widths.x - widths.y * widths.y) * (span.along.y - span.along.x);
}

// Its centre of area, as weights of corners 1 and 2.
vec2 middle_of(Span span, uint apex) {
    vec2 widths = 1.0 - span.across;
    // Of a trapezoid, which is a triangle at the apex.
    float across = span.across.x + (span.across.y - span.across.x) * (widths.x + 2.0 * widths.y) / (3.0 * (widths.x + widths.y));
    return place_at(apex, vec2(0.5 * (span.along.x + span.along.y), across));
}

// How long it is at its longer side, and how high, of a triangle's longest edge and its height over that.
vec2 extent_of(Span span, vec2 whole) {
    return whole * vec2((span.along.y - span.along.x) * (1.0 - span.across.x), span.across.y - span.across.x);
}

// A point of a part by two numbers from 0 to 1, evenly over its area.
vec2 even_place_in(Span span, uint apex, vec2 square) {
    vec2 widths = 1.0 - span.across;
    float across = 1.0 - sqrt(mix(widths.x * widths.x, widths.y * widths.y, square.y));
    return place_at(apex, vec2(mix(span.along.x, span.along.y, square.x), across));
}

#endif
