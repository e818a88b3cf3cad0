#version 460
#include "lib/prelude.glsl"

// Marks the radiance particles of one subtriangle that is seen.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer tessellation;
layout(set = 0, binding = 1) uniform usamplerBuffer subtriangles;
layout(set = 0, binding = 2) uniform usamplerBuffer found;
layout(set = 0, binding = 3) buffer Marks { uint marks[]; };

#include "particles/mesh_found.glsl"
#include "particles/mesh_tessellation.glsl"

void main() {
    uint invocation = invocation_of_found();
    if (invocation >= texelFetch(found, 3).x) {
        return;
    }
    uint number = texelFetch(subtriangles, int(invocation)).x;
    Tessellated t = load_tessellated(triangle_of_number(number, true, tessellated_triangle_count()));
    uint local = number - t.first_subtriangle;
    uint sides = sides_of(t);
    RowPlace points[3] = points_of_subtriangle(t, local / sides);
    for (uint point = 0u; point < 3u; ++point) {
        uint particle = particle_at(t, points[point], local % sides);
        atomicOr(marks[particle >> 5], 1u << (particle & 31u));
    }
}
