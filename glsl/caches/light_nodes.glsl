// Neighbouring groups of virtual area lights together: a node of level k is 4^k of them along Morton's curve, the last one fewer. Of each a texel: the middle of a sphere around it, in
// render space, and its radius. The levels stand one after the other, from the first; level 0 is the groups themselves.
#ifndef CACHES_LIGHT_NODES
#define CACHES_LIGHT_NODES

const int NODE_LEVELS = 3;

// Where a level begins, with so many groups at most.
int first_node_of_level(int group_count, int level) {
    int first = 0;
    for (int below = 1; below < level; ++below) {
        first += (group_count + (1 << (2 * below)) - 1) >> (2 * below);
    }
    return first;
}

#endif
