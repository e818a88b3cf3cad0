// A grid over space that repeats after 2^bits cells along each axis: neighbours never share a bucket, far cells may, which the distance of what is in them tells
// apart.
#ifndef BUCKETS_WRAPPED
#define BUCKETS_WRAPPED

uint bucket_of(ivec3 cell, uint bits) {
    uvec3 wrapped = uvec3(cell) & ((1u << bits) - 1u);
    return (wrapped.z << bits | wrapped.y) << bits | wrapped.x;
}

#endif
