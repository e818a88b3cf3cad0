// How far apart particles are: of each cell of a triangle (facets.glsl) a step on a scale from the closest to the widest, whose spacing is 8 times as large. Evenly
// spread, all are on the first step. Two words of each cell: its area over the square of the spacing, in closest ones, and that step. Of a side of a triangle whose
// cells are all on one step the first stands for all of it, and the others have no area (whole.comp).
#ifndef PARTICLES_WIDTHS
#define PARTICLES_WIDTHS

const uint STEPS_A_DOUBLING = 10u;
const uint MOST_WIDTH = 30u;
// Set of a cell that stands for its whole side.
const uint WHOLE_SIDE = 0x80000000u;

// Of a step the spacing over the closest one.
float spacing_of_width(uint width) {
    return width == 0u ? 1.0 : exp2(float(width) / float(STEPS_A_DOUBLING));
}

uint width_of_spacing(float ratio) {
    return uint(clamp(float(STEPS_A_DOUBLING) * log2(max(ratio, 1e-30)) + 0.5, 0.0, float(MOST_WIDTH)));
}

// Level of the grid (grid.glsl).
uint level_of_width(uint width) {
    return (width + STEPS_A_DOUBLING - 1u) / STEPS_A_DOUBLING;
}

#endif
