#version 460
#include "lib/prelude.glsl"

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// One invocation sums 4x4 blocks of one level of the mask's pyramid into the two levels above it, W, and counts on each the blocks that are
// not empty (Quyen 2014, section 3.3.1.1, whose pyramid averages ones). The mask itself is read where it belongs to a view alone. What is
// empty was so before. Every sum is of four in a fixed order: the same bits every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, r32f) readonly uniform image2D mask;
layout(set = 0, binding = 1) uniform usamplerBuffer levels;
layout(set = 0, binding = 2) uniform usamplerBuffer tiles;  // r32ui: column and row, 16 bits each, of the views' squares of 16x16 texels
layout(set = 0, binding = 3) buffer PyramidBlock { uint pyramid[]; };

layout(push_constant, scalar) uniform Push {
    uint level;
    uint columns;  // invocations in a row, above level 0
    uint count;    // invocations
} push;

#include "photons/pyramid.glsl"

// What is no number is counted.
float flux_of_block(Level level, ivec2 block) {
    if (push.level == 0u) {
        float flux = imageLoad(mask, block).x;
        if (!is_finite(flux)) {
            atomicAdd(pyramid[PYRAMID_DROPPED], 1u);
        }
        return sound_flux(flux);
    }
    return holds(level, block) ? uintBitsToFloat(pyramid[place_of_block(level, block)]) : 0.0;
}

// Column and row of the 4x4 blocks.
ivec2 place_of_invocation(uint index) {
    if (push.level > 0u) {
        return ivec2(index % push.columns, index / push.columns);
    }
    uint tile = texelFetch(tiles, int(index >> 4)).x;
    return 4 * ivec2(tile & 0xFFFFu, tile >> 16) + ivec2(index & 3u, index >> 2 & 3u);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    uvec3 taken = uvec3(0u);
    if (index < push.count) {
        Level source = load_level(push.level);
        Level middle = load_level(push.level + 1u);
        Level top = load_level(push.level + 2u);
        ivec2 place = place_of_invocation(index);
        vec4 sums = vec4(0.0);
        [[dont_unroll]] for (int part = 0; part < 4; ++part) {
            ivec2 block = 2 * place + ivec2(part & 1, part >> 1);
            ivec2 first = 2 * block;
            vec4 quad = vec4(
                flux_of_block(source, first), flux_of_block(source, first + ivec2(1, 0)),
                flux_of_block(source, first + ivec2(0, 1)), flux_of_block(source, first + ivec2(1, 1)));
            float sum = (quad.x + quad.y) + (quad.z + quad.w);
            if (sum > 0.0) {
                taken.xy += uvec2(uint(quad.x > 0.0) + uint(quad.y > 0.0) + uint(quad.z > 0.0) + uint(quad.w > 0.0), 1u);
                pyramid[place_of_block(middle, block)] = floatBitsToUint(sum);
            }
            sums[part] = sum;
        }
        float sum = (sums.x + sums.y) + (sums.z + sums.w);
        if (sum > 0.0 && holds(top, place)) {
            taken.z = 1u;
            pyramid[place_of_block(top, place)] = floatBitsToUint(sum);
        }
    }
    // The lowest level was counted by the pass below, as its highest.
    uvec3 counts = subgroupAdd(taken);
    if (subgroupElect() && counts.y > 0u) {
        if (push.level == 0u) {
            atomicAdd(pyramid[0], counts.x);
        }
        atomicAdd(pyramid[push.level + 1u], counts.y);
        atomicAdd(pyramid[push.level + 2u], counts.z);
    }
}
