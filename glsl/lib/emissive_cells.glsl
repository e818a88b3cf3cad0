// Where on emissive triangles points are drawn: evenly, or cell by cell where a texture or alpha leaves parts of a triangle dark. With n
// cells an edge, column i = ⌊n·b₁⌋ and row j = ⌊n·b₂⌋ hold a lower cell and, where the fractions add up to more than 1, an upper one that
// is upside down; it has the number j·(2n − j) + 2i + upper (src/scene/triangle_cells.rs).
//
// One texel of `triangles` a cell, an alias table (Vose 1991):
//
//   threshold | number of the other cell | density over the triangle's mean density | i | j << 16 | upper << 31
#ifndef LIB_EMISSIVE_CELLS
#define LIB_EMISSIVE_CELLS

#include "groups/scene_rays.glsl"
#include "lib/traced_scene.glsl"

uint cells_an_edge(Triangle triangle) {
    return triangle.cells >> 25;
}

int first_cell(Triangle triangle) {
    return textureSize(triangles) - int(triangle.cells & 0x1FFFFFFu);
}

struct EmissivePoint {
    vec2 place;     // the weights of corners 1 and 2
    float density;  // with which next-event estimation takes it, 1/m²
};

// Uniform in area (Osada et al. 2002): barycentric coordinates of corners 1 and 2.
vec2 place_in_triangle(vec2 random) {
    float root = sqrt(random.x);
    return vec2(root * (1.0 - random.y), root * random.y);
}

EmissivePoint draw_emissive_point(Triangle triangle, vec2 random) {
    if (EMISSIVE_CELLS == 0u || triangle.cells == 0u) {
        return EmissivePoint(place_in_triangle(random), triangle.light_density);
    }
    float side = float(cells_an_edge(triangle));
    float scaled = random.x * side * side;
    uint number = min(uint(scaled), cells_an_edge(triangle) * cells_an_edge(triangle) - 1u);
    float part = clamp(scaled - float(number), 0.0, 1.0);
    uvec4 cell = texelFetch(triangles, first_cell(triangle) + int(number));
    // What is left of the number is as even as it was.
    float threshold = uintBitsToFloat(cell.x);
    if (part < threshold) {
        part /= threshold;
    } else {
        part = (part - threshold) / max(1.0 - threshold, 1e-9);
        cell = texelFetch(triangles, first_cell(triangle) + int(cell.y));
    }
    vec2 place = place_in_triangle(vec2(min(part, 1.0), random.y));
    bool upper = cell.w >> 31 != 0u;
    vec2 corner = vec2(cell.w & 0xFFFFu, cell.w >> 16 & 0x7FFFu);
    return EmissivePoint((corner + (upper ? 1.0 - place : place)) / side, triangle.light_density * uintBitsToFloat(cell.z));
}

// The density at a point, whoever found it.
float emissive_density(Triangle triangle, vec2 place) {
    if (EMISSIVE_CELLS == 0u || triangle.cells == 0u || triangle.light_density <= 0.0) {
        return triangle.light_density;
    }
    int side = int(cells_an_edge(triangle));
    vec2 scaled = clamp(place, 0.0, 1.0) * float(side);
    ivec2 corner = min(ivec2(scaled), side - 1);
    // On the longest edge rounding may lead beyond it.
    corner.x = min(corner.x, side - 1 - corner.y);
    vec2 part = scaled - vec2(corner);
    bool upper = part.x + part.y > 1.0 && corner.x + corner.y < side - 1;
    int number = corner.y * (2 * side - corner.y) + 2 * corner.x + (upper ? 1 : 0);
    return triangle.light_density * uintBitsToFloat(texelFetch(triangles, first_cell(triangle) + number).z);
}

#endif
