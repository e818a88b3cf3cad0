// Rays to and from light caches: where the scene that rays meet lies.
#ifndef CACHES_RAYS
#define CACHES_RAYS

struct CacheRays {
    vec3 shift;  // from render space to the rays' space
};

#endif
