// The grid that photons are binned in. Level l has cells of 2·2^l samples to a side, and holds the photons whose discs reach up to
// 4·2^l samples from their centre (level 0: all that reach less). So each photon stands in one cell, whatever its size: a list as
// long as there are photons cannot overflow; and a sample finds all that reach it in the few cells around its own. The last
// level is a single cell, whose photons may reach anywhere.
//
// `levels`, a texel (rgba32ui) a level: columns, rows, first cell, 0. A row of cells is followed by one that stays empty.
#ifndef PHOTON_SPLAT_LEVELS
#define PHOTON_SPLAT_LEVELS

int cell_log2(int level) {
    return level + 1;
}

float reach_of_level(int level) {
    return float(4 << level);
}

// The first and the last column and row of cells with the photons that may reach the samples low … high, beside which `border` samples
// count too.
ivec4 cells_around(ivec2 low, ivec2 high, float border, int level, uvec4 cells) {
    float side = float(1 << cell_log2(level));
    float reach = reach_of_level(level) + border;
    ivec2 first = ivec2(floor((vec2(low) + 0.5 - reach) / side));
    ivec2 last = ivec2(floor((vec2(high) + 0.5 + reach) / side));
    ivec2 most = ivec2(cells.xy) - 1;
    return ivec4(clamp(first, ivec2(0), most), clamp(last, ivec2(0), most));
}

// The index of a cell in the lists of all cells.
int cell_index(ivec2 cell, uvec4 cells) {
    return int(cells.z) + cell.y * int(cells.x + 1u) + cell.x;
}

#endif
