#version 460
#include "lib/prelude.glsl"

// One group turns the areas of blocks of triangles into sums before each: area_before[b] = Σ_{s<b} block_areas[s], the scene's area [m²]
// at the end.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) readonly buffer BlockAreas { float block_areas[]; };
layout(set = 0, binding = 1) writeonly buffer AreaBefore { float area_before[]; };

layout(push_constant, scalar) uniform Push { uint block_count; } push;

#define SCAN_TYPE float

float scan_term(uint block) {
    return block_areas[block];
}

void scan_store(uint block, float before) {
    area_before[block] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.block_count);
}
