// Places at the end of lists, by one atomic addition a subgroup, of any size. A subgroup gets neighbouring places in the order of its
// invocations; the order of subgroups differs from run to run.
//
// All invocations of the workgroup must come here together: SPIR-V lets them meet again behind a branch, in which the first one adds, only where
// they came to it together. Fragments never do, and append by an addition each (photon_lists/append.glsl).
#ifndef LIB_APPEND
#define LIB_APPEND

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

// For each invocation that follows `before` others of its subgroup, which want `total` places together: sets the uint `place` to its first
// place in the list, whose length is the word `counter` of a storage buffer. Where the list grew one invocation runs the statement `then`, in
// which `new_length` is how long it became at least; {} if there is nothing to do.
#define APPEND_SEVERAL(counter, before, total, place, then)                                                      \
    {                                                                                                            \
        uint old_length = 0u;                                                                                    \
        if (subgroupElect() && (total) > 0u) {                                                                   \
            old_length = atomicAdd(counter, total);                                                              \
            uint new_length = old_length + (total);                                                              \
            then;                                                                                                \
        }                                                                                                        \
        place = subgroupBroadcastFirst(old_length) + (before);                                                   \
    }

// One place for each invocation that has one `wanted`; the others' `place` means nothing.
#define APPEND(counter, wanted, place, then)                                                                     \
    {                                                                                                            \
        uvec4 voters = subgroupBallot(wanted);                                                                   \
        uint voter_count = subgroupBallotBitCount(voters);                                                       \
        APPEND_SEVERAL(counter, subgroupBallotExclusiveBitCount(voters), voter_count, place, then)               \
    }

#endif
