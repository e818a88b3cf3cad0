#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "particles/albedo.glsl"

// What one triangle has of diffuse surface, m²: its area, twice if both sides count, 0 where no diffuse lobe is or far from all that matters.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Areas { float areas[]; };

layout(push_constant, scalar) uniform Push {
    vec3 middle;
    float radius;
    uint triangle_count;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.triangle_count) {
        return;
    }
    Triangle triangle = load_triangle(triangles, index);
    Material material = load_material(materials, triangle.material);
    vec3 centre = triangle.origin + (triangle.edge1 + triangle.edge2) / 3.0;
    vec3 out0 = triangle.origin - centre;
    float extent = sqrt(max(dot(out0, out0), max(dot(out0 + triangle.edge1, out0 + triangle.edge1), dot(out0 + triangle.edge2, out0 + triangle.edge2))));
    bool matters = distance(centre, push.middle) - extent <= push.radius;
    float sides = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? 2.0 : 1.0;
    float area = 0.5 * length(cross(triangle.edge1, triangle.edge2)) * sides;
    areas[index] = has_diffuse_lobe(material) && matters && is_finite(area) ? area : 0.0;
}
