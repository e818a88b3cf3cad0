// Which pixels of a group of 8×8 speak for others: of those that would say the same, the ones without such a neighbour to the left or above. From any other
// pixel these steps lead to one that speaks, so that nothing is left unsaid. (The listing of Reich 2015, 4.5.3, clamps the neighbour's place to the tile: a pixel of its first
// row or column then finds itself there and keeps silent.)
#ifndef CACHES_SPEAKING
#define CACHES_SPEAKING

// What the pixels would say of the one cascade, and of the next.
shared uint said[2 * 64];

// `in_group`: the pixel's place in the group. All invocations must come here once for each list, and to a barrier then.
void say(uvec2 in_group, int list, uint what) {
    said[list * 64 + int(8u * in_group.y + in_group.x)] = what;
}

bool speaks(uvec2 in_group, int list, uint what) {
    int self = list * 64 + int(8u * in_group.y + in_group.x);
    bvec2 inside = greaterThan(in_group, uvec2(0u));
    bool left = inside.x && said[self - 1] == what;
    bool above = inside.y && said[self - 8] == what;
    return !left && !above;
}

#endif
