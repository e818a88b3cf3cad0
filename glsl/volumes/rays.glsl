// Rays to and from light caches: where the scene that rays meet lies.
#ifndef VOLUMES_RAYS
#define VOLUMES_RAYS

struct VolumeRays {
    vec3 shift;  // from render space to the rays' space
};

#endif
