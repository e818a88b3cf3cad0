#version 460
#include "lib/prelude.glsl"
#include "cubemap/cube.glsl"

// One texel of the levels above the map: the mean of the map over its square, by solid angle.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Boxes { vec4 boxes[]; };

void main() {
    uint index = gl_GlobalInvocationID.x + first_of_boxes(1u);
    if (index >= first_of_boxes(BOX_LEVELS)) {
        return;
    }
    uint level = 1u;
    [[dont_unroll]] while (level + 1u < BOX_LEVELS && index >= first_of_boxes(level + 1u)) {
        ++level;
    }
    uint side = side_of_boxes(level);
    uint texel = index - first_of_boxes(level);
    uint face = texel / (side * side);
    uvec2 corner = uvec2(texel % side, texel / side % side) << level;
    uint width = 1u << level;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    [[dont_unroll]] for (uint i = 0u; i < width * width; ++i) {
        uvec2 column_row = corner + uvec2(i & (width - 1u), i >> level);
        uint finest = (face * CUBE_SIDE + column_row.y) * CUBE_SIDE + column_row.x;
        float weight = relative_solid_angle(direction_of_texel(finest, CUBE_SIDE));
        sum += weight * boxes[finest].rgb;
        weights += weight;
    }
    boxes[index] = vec4(sum / weights, 0.0);
}
