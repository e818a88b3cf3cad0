// Queues of paths: what one kernel leaves for the next. Words 0 to 2 are the arguments of an indirect dispatch of groups of 64,
// word 3 is the count, then come the numbers of the paths.
#ifndef PATH_QUEUE
#define PATH_QUEUE

#include "lib/append.glsl"

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

// One place in a queue, `queue[3]` of which is the count, for each invocation that has one `wanted` (lib/append.glsl).
#define QUEUE_PLACE(queue, wanted, place) APPEND(queue[3], wanted, place, atomicMax(queue[0], (new_length + 63u) / 64u))

// Appends `path` to the storage buffer `queue` if `wanted`.
#define APPEND_TO_QUEUE(queue, path, wanted)                                                                     \
    {                                                                                                            \
        uint in_queue;                                                                                           \
        QUEUE_PLACE(queue, wanted, in_queue)                                                                     \
        if (wanted) {                                                                                            \
            queue[QUEUE_HEADER + in_queue] = path;                                                               \
        }                                                                                                        \
    }

#endif
