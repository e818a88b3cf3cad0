#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "particles/albedo.glsl"
#include "particles/sides.glsl"

// What one triangle has of diffuse surface, m²: its area, twice if both sides count, 0 where no diffuse lobe is or far from all that matters. It is the same number
// wherever the triangle moves, so that all particles stay where they are on theirs.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer own_areas;
layout(set = 0, binding = 1) writeonly buffer Areas { float areas[]; };
layout(set = 0, binding = 2) uniform usamplerBuffer backs;

layout(push_constant, scalar) uniform Push { uint triangle_count; } push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.triangle_count) {
        return;
    }
    Material material = load_material(materials, load_triangle(triangles, index).material);
    float sides = has_both_sides(backs, index, material) ? 2.0 : 1.0;
    float area = texelFetch(own_areas, int(index)).x * sides;
    areas[index] = has_diffuse_lobe(material) && is_finite(area) ? area : 0.0;
}
