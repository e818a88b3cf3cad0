#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "vpl/regions.glsl"

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

// One texel of the flattened image: if its region is valid (alg. 3.1 of Quyen 2014), it goes on the list. Words 0 to 2 of the list are
// the groups that gather for it, word 3 is its length, then come the regions as x | y << 16, texels of the flattened image. Their order
// differs from run to run, what is made of them does not.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D planes;
layout(set = 0, binding = 2) buffer List { uint list[]; };

layout(push_constant, scalar) uniform Push {
    ivec2 size;         // pixels
    int level_count;
    uint group_size;    // regions that one group gathers for
} push;

void main() {
    ivec2 texel = pixel_of_invocation();
    if (gl_GlobalInvocationID == uvec3(0u)) {
        list[1] = 1u;
        list[2] = 1u;
    }
    bool valid = texel.y < push.size.y
                 && is_valid(depth, planes, push.size, region_at(push.size, texel, push.level_count), push.level_count);
    uvec4 voters = subgroupBallot(valid);
    uint count = subgroupBallotBitCount(voters);
    uint first = 0u;
    if (subgroupElect() && count > 0u) {
        first = atomicAdd(list[3], count);
        atomicMax(list[0], (first + count + push.group_size - 1u) / push.group_size);
    }
    first = subgroupBroadcastFirst(first);
    if (valid) {
        list[4u + first + subgroupBallotExclusiveBitCount(voters)] = uint(texel.x) | uint(texel.y) << 16;
    }
}
