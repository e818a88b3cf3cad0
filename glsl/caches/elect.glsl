// Which pixels of a group of 8×8 speak for their neighbours: of those that ask for the same eight nodes, in a way that `elect` is told of by a word besides, the ones without
// such a neighbour to the left, above, or left above. From any other pixel these steps lead to one that speaks, so that no node is forgotten. (The listing in Reich 2015,
// section 4.5.3, clamps the neighbour's place to the tile: a pixel of its first row or column then finds itself there and keeps silent.)
//
// The group is of 8×8 invocations, one a pixel.
#ifndef CACHES_ELECT
#define CACHES_ELECT

shared uvec2 asked[64];

// `key.x`: the address of the lowest node, or NO_ADDRESS. All invocations of the group must come here.
bool elect(uvec2 key) {
    uint self = gl_LocalInvocationIndex;
    asked[self] = key;
    barrier();
    bvec2 inside = greaterThan(gl_LocalInvocationID.xy, uvec2(0u));
    bool left = inside.x && asked[self - 1u] == key;
    bool above = inside.y && asked[self - 8u] == key;
    bool left_above = all(inside) && asked[self - 9u] == key;
    barrier();
    return key.x != NO_ADDRESS && !left && !above && !left_above;
}

#endif
