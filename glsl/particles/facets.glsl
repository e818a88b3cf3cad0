// Facets: triangles cut into n×m parts for each of which one particle stands, so that where a ray ends is looked up instead of searched. Rows lie along the longest
// edge, m of them between it and the corner across, each cut into n: a thin triangle takes as many as it is long. Of each side of two-sided surfaces there are as
// many. A texel a triangle: the first facet, and how it is cut; behind all of them the number of facets.
#ifndef PARTICLES_FACETS
#define PARTICLES_FACETS

const uint NO_FACET = 0xFFFFFFFFu;
const uint MOST_CUTS = 4095u;

struct Cuts {
    uint columns;
    uint rows;
    uint apex;   // the corner across the longest edge
    uint sides;  // 1 or 2
};

uint pack_cuts(Cuts cuts) {
    return cuts.columns | cuts.rows << 12 | cuts.apex << 24 | (cuts.sides - 1u) << 26;
}

Cuts unpack_cuts(uint word) {
    return Cuts(word & 0xFFFu, word >> 12 & 0xFFFu, word >> 24 & 3u, (word >> 26 & 1u) + 1u);
}

uint facets_of(Cuts cuts) {
    return cuts.columns * cuts.rows * cuts.sides;
}

// Of a point of the triangle with that record, by the weights of corners 1 and 2.
uint facet_of(uvec2 record, vec2 place, bool back) {
    Cuts cuts = unpack_cuts(record.y);
    if (facets_of(cuts) == 0u || (back && cuts.sides == 1u)) {
        return NO_FACET;
    }
    vec3 weights = vec3(1.0 - place.x - place.y, place);
    float height = weights[cuts.apex];
    float along = weights[(cuts.apex + 1u) % 3u] / max(1.0 - height, 1e-30);
    uint row = min(uint(max(height, 0.0) * float(cuts.rows)), cuts.rows - 1u);
    uint column = min(uint(clamp(along, 0.0, 1.0) * float(cuts.columns)), cuts.columns - 1u);
    return record.x + ((back ? cuts.rows : 0u) + row) * cuts.columns + column;
}

// Weights of corners 1 and 2 of a point of a facet, whose number is counted from the triangle's first one; `at`: along the row and across, from 0 to 1.
vec2 place_in_facet(Cuts cuts, uint number, vec2 at) {
    float height = (float(number / cuts.columns % cuts.rows) + at.y) / float(cuts.rows);
    float along = (float(number % cuts.columns) + at.x) / float(cuts.columns);
    vec3 weights;
    weights[cuts.apex] = height;
    weights[(cuts.apex + 1u) % 3u] = (1.0 - height) * along;
    weights[(cuts.apex + 2u) % 3u] = (1.0 - height) * (1.0 - along);
    return weights.yz;
}

// The middle of a facet, whose number is counted from the triangle's first one, as weights of corners 1 and 2, and its share of the triangle's area.
vec3 middle_of_facet(Cuts cuts, uint number) {
    uint row = number / cuts.columns % cuts.rows;
    vec2 heights = vec2(row, row + 1u) / float(cuts.rows);
    vec2 widths = 1.0 - heights;
    // Of a trapezoid's area, which is a triangle's at the apex.
    float height = heights.x + (heights.y - heights.x) * (widths.x + 2.0 * widths.y) / (3.0 * (widths.x + widths.y));
    vec2 place = place_in_facet(cuts, number, vec2(0.5, height * float(cuts.rows) - float(row)));
    return vec3(place, (widths.x * widths.x - widths.y * widths.y) / float(cuts.columns));
}

#endif
