// A point that light is sent to by rays, and how it scatters.
#ifndef LIB_RECEIVER
#define LIB_RECEIVER

#include "lib/lobes.glsl"

struct Receiver {
    Surface surface;  // position in the rays' space
    vec3 to_eye;
    vec3 ray_origin;
};

// In the frame of the shading normal.
struct Scattering {
    Matter matter;
    Frame frame;
    vec3 viewer;
    vec3 shares;
};

// Without transmission.
Scattering scattering_of(Receiver receiver) {
    Surface point = receiver.surface;
    Scattering scattering;
    scattering.matter = Matter(
        point.diffuse_albedo, point.f0, point.f90, max(point.roughness * point.roughness, MINIMUM_ALPHA), vec3(0.0), 1.0);
    scattering.frame = frame_around(point.normal);
    vec3 viewer = to_local(scattering.frame, receiver.to_eye);
    scattering.viewer = normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
    scattering.shares = lobe_shares(scattering.matter, scattering.viewer.z);
    return scattering;
}

#endif
