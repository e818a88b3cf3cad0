// By how much a cache counts for a point of a surface beside its trilinear weight. One that is hidden keeps so little that it stands in only where all others are hidden too.
// (Weights by whether the surface faces the cache, as Majercik et al. 2019 have them, make the error larger once caches lie in front of surfaces: 0.103 in place of 0.095 in
// the corridor.)
#ifndef CACHES_WEIGHTS
#define CACHES_WEIGHTS

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

const uint WEIGHTS_TRILINEAR = 0u;
const uint WEIGHTS_RAYS = 1u;

layout(constant_id = 2) const uint WEIGHTS = WEIGHTS_TRILINEAR;

const float LEAST_WEIGHT = 1e-4;

// Both in the space of rays. `share`: the trilinear weight. Caches of next to none are not worth a ray.
float weight_of_cache(vec3 origin, vec3 cache, float share) {
    if (WEIGHTS == WEIGHTS_RAYS && share > LEAST_WEIGHT) {
        return is_occluded(origin, cache - origin, 1.0) ? LEAST_WEIGHT : 1.0;
    }
    return 1.0;
}

#endif
