// Rays from and to virtual point lights: where the scene that rays meet lies.
#ifndef VPL_RAYS
#define VPL_RAYS

struct VplRays {
    vec3 shift;    // from render space to the space of rays
    float radius;  // of the scene, metres
};

#endif
