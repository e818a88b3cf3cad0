// Queues of paths: what one kernel leaves for the next. Words 0 to 2 are the arguments of an indirect dispatch of groups of 64,
// word 3 is the count, then come the numbers of the paths.
#ifndef PATH_QUEUE
#define PATH_QUEUE

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

const uint QUEUE_HEADER = 4u;
const uint NO_PATH = 0xFFFFFFFFu;

uint queue_count(usamplerBuffer queue) {
    return texelFetch(queue, 3).x;
}

// The path of this invocation, or NO_PATH past the end.
uint queued_path(usamplerBuffer queue) {
    uint index = gl_GlobalInvocationID.x;
    return index < queue_count(queue) ? texelFetch(queue, int(QUEUE_HEADER + index)).x : NO_PATH;
}

// Appends `path` to the storage buffer `queue` if `wanted`; all invocations of the subgroup must come here. One atomic a subgroup.
#define APPEND_TO_QUEUE(queue, path, wanted)                                                                     \
    {                                                                                                            \
        uvec4 voters = subgroupBallot(wanted);                                                                   \
        uint voter_count = subgroupBallotBitCount(voters);                                                       \
        uint first = 0u;                                                                                         \
        if (subgroupElect() && voter_count > 0u) {                                                               \
            first = atomicAdd(queue[3], voter_count);                                                            \
            atomicMax(queue[0], (first + voter_count + 63u) / 64u);                                              \
        }                                                                                                        \
        first = subgroupBroadcastFirst(first);                                                                   \
        if (wanted) {                                                                                            \
            queue[QUEUE_HEADER + first + subgroupBallotExclusiveBitCount(voters)] = path;                        \
        }                                                                                                        \
    }

#endif
