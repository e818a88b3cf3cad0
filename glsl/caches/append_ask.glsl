// Adds to the list of what is asked for. The including file has the list as `asks`, its head as `head`, and how many there is room for in `push.capacity`.
#ifndef CACHES_APPEND_ASK
#define CACHES_APPEND_ASK

void append(Ask ask) {
    uint index = atomicAdd(head[3], 1u);
    uint group = index / GROUP_ASKS;
    atomicMax(head[0], min(group + 1u, ROW_GROUPS));
    atomicMax(head[1], group / ROW_GROUPS + 1u);
    atomicMax(head[2], 1u);
    if (index < push.capacity) {
        asks[index] = ask;
    }
}

#endif
