// Rays from and to virtual point lights: where the scene that rays meet lies, and how far from a VPL's surface they start or end.
#ifndef VPL_RAYS
#define VPL_RAYS

struct VplRays {
    vec3 shift;    // from render space to the space of rays
    float offset;  // metres
    float radius;  // of the scene, metres
};

#endif
