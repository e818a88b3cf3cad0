#version 460
#include "lib/prelude.glsl"

// One group sums 16x16 blocks of one level of the mask's pyramid into the four levels above it, W, and counts on each the blocks that are
// not empty (Quyen 2014, section 3.3.1.1, whose pyramid averages ones). Every sum is of four in a fixed order: the same bits every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D mask;
layout(set = 0, binding = 1) uniform usamplerBuffer levels;
layout(set = 0, binding = 2) buffer PyramidBlock { uint pyramid[]; };

layout(push_constant, scalar) uniform Push { uint level; } push;

#include "photons/pyramid.glsl"

shared float sums[64];
shared uint tallies[5];

float flux_of_block(Level level, ivec2 block) {
    if (!holds(level, block)) {
        return 0.0;
    }
    return push.level == 0u ? texelFetch(mask, block, 0).x : uintBitsToFloat(pyramid[place_of_block(level, block)]);
}

void main() {
    uint self = gl_LocalInvocationIndex;
    ivec2 place = ivec2(self & 7u, self >> 3);
    ivec2 group = ivec2(gl_WorkGroupID.xy);
    if (self < 5u) {
        tallies[self] = 0u;
    }
    barrier();

    Level source = load_level(push.level);
    ivec2 first = 16 * group + 2 * place;
    vec4 quad = vec4(
        flux_of_block(source, first), flux_of_block(source, first + ivec2(1, 0)),
        flux_of_block(source, first + ivec2(0, 1)), flux_of_block(source, first + ivec2(1, 1)));
    float sum = (quad.x + quad.y) + (quad.z + quad.w);
    if (sum > 0.0) {
        uint taken = uint(quad.x > 0.0) + uint(quad.y > 0.0) + uint(quad.z > 0.0) + uint(quad.w > 0.0);
        atomicAdd(tallies[0], taken);
    }
    barrier();
    if (tallies[0] == 0u) {
        // The pyramid was emptied before.
        return;
    }
    [[dont_unroll]] for (uint step = 1u; step <= 4u; ++step) {
        // The sums of this level lie in the upper left corner of the group's square.
        int side = 16 >> step;
        bool takes_part = all(lessThan(place, ivec2(side)));
        if (step > 1u && takes_part) {
            int corner = 16 * place.y + 2 * place.x;
            sum = (sums[corner] + sums[corner + 1]) + (sums[corner + 8] + sums[corner + 9]);
        }
        barrier();
        Level target = load_level(push.level + step);
        ivec2 block = side * group + place;
        if (takes_part) {
            sums[8 * place.y + place.x] = sum;
            if (sum > 0.0) {
                atomicAdd(tallies[step], 1u);
            }
            if (holds(target, block)) {
                pyramid[place_of_block(target, block)] = floatBitsToUint(sum);
            }
        }
        barrier();
    }
    // The lowest level was counted by the pass below, as its highest.
    if (self < 5u && (self > 0u || push.level == 0u) && tallies[self] > 0u) {
        atomicAdd(pyramid[push.level + self], tallies[self]);
    }
}
