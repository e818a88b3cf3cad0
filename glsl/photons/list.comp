#version 460
#include "lib/prelude.glsl"
#include "lib/append.glsl"
#include "lib/pixels.glsl"
#include "photons/choice.glsl"

// Lists the blocks of the chosen level that are not empty: column and row in 16 bits each. One group looks at 32x32 of them, eight by eight;
// the levels five and three above hold these squares as one block.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D mask;
layout(set = 0, binding = 1) uniform usamplerBuffer levels;
layout(set = 0, binding = 2) uniform usamplerBuffer pyramid;
layout(set = 0, binding = 3) buffer ChoiceBlock { uint choice[]; };
layout(set = 0, binding = 4) writeonly buffer BlockList { uint blocks[]; };

layout(push_constant, scalar) uniform Push {
    uint level_count;
    uint capacity;
} push;

#include "photons/pyramid.glsl"

bool is_taken(uint number, ivec2 block) {
    Level level = load_level(number);
    if (!holds(level, block)) {
        return false;
    }
    return number == 0u ? texelFetch(mask, block, 0).x > 0.0 : uintBitsToFloat(texelFetch(pyramid, int(place_of_block(level, block))).x) > 0.0;
}

// Whether the square of 2^above blocks to a side may hold some.
bool may_hold(uint level, uint above, ivec2 square) {
    return level + above >= push.level_count || is_taken(level + above, square);
}

void main() {
    uint level = choice[CHOICE_LEVEL];
    if (!may_hold(level, 5u, ivec2(gl_WorkGroupID.xy))) {
        return;
    }
    uint lane = gl_LocalInvocationIndex & 7u;
    uint part = gl_LocalInvocationIndex >> 3;
    uvec2 in_square = uvec2((part & 1u) * 4u + (lane & 3u), (part >> 1) * 2u + (lane >> 2));
    [[dont_unroll]] for (uint index = 0u; index < 16u; ++index) {
        uvec2 square = gl_WorkGroupID.xy * 4u + uvec2(index & 3u, index >> 2);
        if (!may_hold(level, 3u, ivec2(square))) {
            continue;
        }
        ivec2 block = ivec2(square * 8u + in_square);
        bool taken = is_taken(level, block);
        uint place;
        APPEND(choice[CHOICE_LISTED], taken, place, {})
        if (taken && place < push.capacity) {
            blocks[place] = uint(block.y) << 16 | uint(block.x);
        }
    }
}
