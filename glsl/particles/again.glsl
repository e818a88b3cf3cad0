// A list of what is to be done again, as a pass leaves it for the next one: how much that is, and its numbers. Where more is than the list holds, all is done again.
#ifndef PARTICLES_AGAIN
#define PARTICLES_AGAIN

// Words of the list's head: three say how many groups that takes, then how many numbers there are, and 1 where the list does not hold them.
const uint AGAIN_COUNT = 3u;
const uint ALL_AGAIN = 4u;
// Groups along x, and what each does. gl_WorkGroupSize is 1 where a header comes before its declaration.
const uint MOST_GROUPS = 32768u;
const uint LIST_GROUP = 64u;

uint invocation_of_list() {
    return gl_WorkGroupID.y * (MOST_GROUPS * LIST_GROUP) + gl_GlobalInvocationID.x;
}

// The number that an invocation is to do, of `count` there are; others than these are none.
uint number_again(usamplerBuffer head, usamplerBuffer list, uint count) {
    uint invocation = invocation_of_list();
    if (texelFetch(head, int(ALL_AGAIN)).x != 0u) {
        return invocation;
    }
    return invocation < texelFetch(head, int(AGAIN_COUNT)).x ? texelFetch(list, int(invocation)).x : count;
}

#endif
