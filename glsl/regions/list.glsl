// The list of valid regions (alg. 3.1 of Quyen 2014). Words 0 to 2 are the groups that gather for it, in rows of ROW_GROUPS if there are
// more, since no device need dispatch more than 65,535 along an axis. Word 3 is its length, then come the regions as x | y << 16, texels of the
// flattened image. Their order differs from run to run, what is made of them does not.
//
// A region is valid if it is flat but the next larger one is not: whoever merges four quarters into a region knows both.

#include "lib/append.glsl"

#extension GL_KHR_shader_subgroup_arithmetic : require

layout(set = 0, binding = 0) buffer List { uint list[]; };

layout(constant_id = 0) const uint LISTS = 0u;        // 0: nobody wants the list
layout(constant_id = 1) const uint GROUP_REGIONS = 1u;  // regions that one group gathers for

const uint LIST_HEADER = 4u;
const uint ROW_GROUPS = 32768u;

// All invocations of the group must come here. Bit i of `valid`: quarter i of the region, bit 4: the region itself.
void append_regions(uint valid, ivec2 size, int level, ivec2 cell) {
    if (gl_GlobalInvocationID == uvec3(0u)) {
        list[2] = 1u;
    }
    uint count = uint(bitCount(valid));
    uint before = subgroupExclusiveAdd(count);
    uint total = subgroupAdd(count);
    uint place;
    APPEND_SEVERAL(list[3], before, total, place, {
        uint groups = (new_length + GROUP_REGIONS - 1u) / GROUP_REGIONS;
        atomicMax(list[0], min(groups, ROW_GROUPS));
        atomicMax(list[1], (groups + ROW_GROUPS - 1u) / ROW_GROUPS);
    })
    place += LIST_HEADER;
    for (int i = 0; i < 5; ++i) {
        if ((valid >> i & 1u) != 0u) {
            ivec2 texel = i == 4 ? place_of_level(size, level) + cell
                                 : place_of_level(size, level - 1) + 2 * cell + ivec2(i & 1, i >> 1);
            list[place] = uint(texel.x) | uint(texel.y) << 16;
            ++place;
        }
    }
}

// Bits of the quarters that are flat if the whole is not, and of the whole if it is and no larger one is asked for.
uint valid_regions(Square quarters[4], Square whole, bool largest) {
    if (whole.plane.x > 0.0) {
        return largest ? 16u : 0u;
    }
    uint valid = 0u;
    for (int i = 0; i < 4; ++i) {
        valid |= quarters[i].plane.x > 0.0 ? 1u << i : 0u;
    }
    return valid;
}
