// Where a triangle lies on its surface's light map, three texels (rgba32ui) a triangle:
//
//   corner 0 in texels | corner 1
//   corner 2 | number of the first texel of its front | of its back     NO_TEXEL: that side has no map
//   width and height of the map | the larger size of a texel, m | number of the surface
//
// Texels are numbered row by row and lie on whole numbers, borders included.
#ifndef LIGHTMAPS_CHARTS
#define LIGHTMAPS_CHARTS

const uint NO_TEXEL = 0xFFFFFFFFu;
// In the number of a texel's triangle.
const uint TEXEL_BACK = 0x80000000u;

struct Chart {
    vec2 corners[3];
    uint first_front;
    uint first_back;
    ivec2 size;
    float texel;  // m
};

Chart load_chart(usamplerBuffer charts, uint triangle) {
    int first = 3 * int(triangle);
    uvec4 a = texelFetch(charts, first);
    uvec4 b = texelFetch(charts, first + 1);
    uvec4 c = texelFetch(charts, first + 2);
    vec2 corners[3] = vec2[](uintBitsToFloat(a.xy), uintBitsToFloat(a.zw), uintBitsToFloat(b.xy));
    return Chart(corners, b.z, b.w, ivec2(c.xy), uintBitsToFloat(c.z));
}

// The first texel of a side; NO_TEXEL: it has no map.
uint first_of_side(Chart chart, bool back) {
    return back ? chart.first_back : chart.first_front;
}

// Where a texel lies among those of its side.
ivec2 place_on_map(Chart chart, uint first, uint texel) {
    return ivec2(int(texel - first) % chart.size.x, int(texel - first) / chart.size.x);
}

// Where a point of a triangle lies on its map. `place`: the weights of corners 1 and 2.
vec2 point_on_map(Chart chart, vec2 place) {
    return (1.0 - place.x - place.y) * chart.corners[0] + place.x * chart.corners[1] + place.y * chart.corners[2];
}

// Four texels around a point of a map, by number, and the weights of bilinear interpolation. The first one is that by which their cell goes.
struct Cell {
    uvec4 texels;
    vec4 weights;
};

// The cell whose lowest texel is `low`.
uvec4 texels_of_cell(uint first, ivec2 size, ivec2 low) {
    ivec2 high = min(low + 1, size - 1);
    ivec4 columns = ivec4(low.x, high.x, low.x, high.x);
    ivec4 rows = ivec4(low.y, low.y, high.y, high.y);
    return uvec4(int(first) + rows * size.x + columns);
}

Cell cell_at(uint first, ivec2 size, vec2 at) {
    vec2 inside = clamp(at, vec2(0.0), vec2(size - 1));
    ivec2 low = min(ivec2(inside), max(size - 2, ivec2(0)));
    vec2 part = inside - vec2(low);
    vec4 weights = vec4(1.0 - part.x, part.x, 1.0 - part.x, part.x) * vec4(vec2(1.0 - part.y), vec2(part.y));
    return Cell(texels_of_cell(first, size, low), weights);
}

#endif
