// Cells of triangles, one after the other, each a texel: the weighted areas before it, the triangle, which of its n² congruent parts it is, and the inverse of its
// weight. Behind all of them stands the total. Particles lie as densely as weights say (cell_weights.comp); evenly spread, a cell is a triangle and weighs 1.
#ifndef PARTICLES_CELLS
#define PARTICLES_CELLS

// 1/weight, in steps.
const uint INVERSE_WEIGHT_STEPS = 64u;
// Parts along a triangle's edge at most.
const uint MOST_PARTS = 255u;

uvec4 cell_record(float area, uint triangle, uint number, uint parts, uint inverse_weight) {
    return uvec4(floatBitsToUint(area), triangle, number | parts << 16, inverse_weight);
}

uint part_of_cell(uvec4 cell) {
    return cell.z & 0xFFFFu;
}

uint parts_of_cell(uvec4 cell) {
    return cell.z >> 16;
}

vec2 part_corner(uint row, uint column, uint parts) {
    return vec2(row - column, column) / float(parts);
}

// Weights of corners 1 and 2 of the triangle, from those of a part: row r, seen from corner 0, has 2r + 1 of them.
vec2 place_of_part(vec2 place, uint part, uint parts) {
    if (parts <= 1u) {
        return place;
    }
    uint row = uint(sqrt(float(part)));
    row = row * row > part ? row - 1u : (row + 1u) * (row + 1u) <= part ? row + 1u : row;
    uint along = part - row * row;
    uint column = along / 2u;
    bool upright = (along & 1u) == 0u;
    vec2 a = part_corner(row, column, parts);
    vec2 b = upright ? part_corner(row + 1u, column, parts) : part_corner(row + 1u, column + 1u, parts);
    vec2 c = upright ? part_corner(row + 1u, column + 1u, parts) : part_corner(row, column + 1u, parts);
    return a + place.x * (b - a) + place.y * (c - a);
}

#endif
