#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/traced_scene.glsl"
#include "particles/sides.glsl"

// The longest edge of one triangle and its height over that, m; the corner across; how many sides count. 0 where no particle stands.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer areas;  // twice a triangle's if both sides count
layout(set = 0, binding = 1) writeonly buffer Sizes { vec4 sizes[]; };
layout(set = 0, binding = 2) uniform usamplerBuffer backs;

layout(push_constant, scalar) uniform Push { uint triangle_count; } push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.triangle_count) {
        return;
    }
    float area = texelFetch(areas, int(index)).x;
    Triangle triangle = load_triangle(triangles, index);
    bool both_sides = has_both_sides(backs, index, load_material(materials, triangle.material));
    vec3 edge = triangle.edge2 - triangle.edge1;
    // Across from corners 0, 1, 2.
    vec3 lengths2 = vec3(dot(edge, edge), dot(triangle.edge2, triangle.edge2), dot(triangle.edge1, triangle.edge1));
    float longest2 = max(lengths2.x, max(lengths2.y, lengths2.z));
    float apex = longest2 == lengths2.x ? 0.0 : longest2 == lengths2.y ? 1.0 : 2.0;
    float longest = sqrt(longest2);
    float height = length(cross(triangle.edge1, triangle.edge2)) / max(longest, 1e-30);
    bool counts = area > 0.0 && is_finite(longest);
    sizes[index] = counts ? vec4(longest, height, apex, both_sides ? 2.0 : 1.0) : vec4(0.0);
}
