// Places at the end of a list for some invocations of a subgroup, by one atomic addition. `counts` holds STAGE_WORDS words a list
// (photons/records.glsl), which follow what is appended. All invocations of the subgroup must come here. Sets the uint `place`.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

#define APPEND(counts, stage, wanted, place)                                                                     \
    {                                                                                                            \
        uvec4 voters = subgroupBallot(wanted);                                                                   \
        uint voter_count = subgroupBallotBitCount(voters);                                                       \
        uint first = 0u;                                                                                         \
        if (subgroupElect() && voter_count > 0u) {                                                               \
            uint head = (stage) * STAGE_WORDS;                                                                   \
            first = atomicAdd(counts[head + COUNT_WORD], voter_count);                                           \
            atomicMax(counts[head], (first + voter_count + 63u) / 64u);                                          \
            atomicMax(counts[head + DRAW_WORD + 1u], first + voter_count);                                       \
        }                                                                                                        \
        place = subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(voters);                         \
    }
