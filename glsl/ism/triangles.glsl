// The scene's triangles as instances place them, and where points are drawn from them by area. Triangles are numbered through all
// instances; blocks of 256 have partial sums of areas.
#ifndef ISM_TRIANGLES
#define ISM_TRIANGLES

#include "groups/geometry.glsl"
#include "lib/vectors.glsl"

const uint BLOCK_TRIANGLES = 256u;

layout(set = 0, binding = 0) uniform usamplerBuffer first_triangles;  // of each instance, and the total

vec3 corner_rs(mat3x4 object_to_render, int vertex) {
    int first = 3 * vertex;
    vec3 position =
        vec3(texelFetch(positions, first).x, texelFetch(positions, first + 1).x, texelFetch(positions, first + 2).x);
    return vec4(position, 1.0) * object_to_render;
}

// The last instance whose first triangle is at most this one.
uint instance_of_triangle(uint triangle, uint instance_count) {
    uint low = 0u;
    uint high = instance_count;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (texelFetch(first_triangles, int(middle)).x <= triangle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// The first corner and the edges from it, in render space.
mat3 corner_and_edges(uint triangle, uint instance_count) {
    uint number = instance_of_triangle(triangle, instance_count);
    Instance instance = load_instance(instances, number);
    int first = int(instance.first_index + 3u * (triangle - texelFetch(first_triangles, int(number)).x));
    mat3 corners;
    [[dont_unroll]] for (int i = 0; i < 3; ++i) {
        int vertex = int(texelFetch(indices, first + i).x) + instance.vertex_offset;
        corners[i] = corner_rs(instance.object_to_render, vertex);
    }
    return mat3(corners[0], corners[1] - corners[0], corners[2] - corners[0]);
}

#endif
