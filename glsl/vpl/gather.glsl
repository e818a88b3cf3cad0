// Irradiance from virtual point lights, all or a range of them, at two receivers, which share the loads of a light,
//
//   E(x) = Σ_k Φ_k/π · F_k(x) · V_k(x)      [W/m²]
//
// F the form factor of lib/disc.glsl, V the visibility of vpl/visibility.glsl, which is asked only where F is above 0. The including file
// binds `uniform samplerBuffer vpls`.
#ifndef VPL_GATHER
#define VPL_GATHER

#include "lib/disc.glsl"
#include "vpl/visibility.glsl"

struct Receiver {
    vec3 position_rs;
    vec3 normal;   // 0: there is no receiver
};

// Which VPLs one pass takes; beyond the first pass, sums are added to.
struct VplRange {
    int first;
    int end;
};

float received_factor(int k, Vpl vpl, Receiver receiver) {
    float factor = disc_form_factor(vpl, receiver.position_rs, receiver.normal);
    if (factor > 0.0) {
        factor *= vpl_visibility(k, vpl, receiver.position_rs, receiver.normal);
    }
    return factor;
}

void gather(VplRange range, Receiver a, Receiver b, out vec3 irradiance_a, out vec3 irradiance_b) {
    irradiance_a = vec3(0.0);
    irradiance_b = vec3(0.0);
    for (int k = range.first; k < range.end; ++k) {
        Vpl vpl = as_disc(unpack_vpl(texelFetch(vpls, 2 * k), texelFetch(vpls, 2 * k + 1)));
        irradiance_a += vpl.strength * received_factor(k, vpl, a);
        irradiance_b += vpl.strength * received_factor(k, vpl, b);
    }
}

void gather(VplRange range, Receiver receiver, out vec3 irradiance) {
    irradiance = vec3(0.0);
    for (int k = range.first; k < range.end; ++k) {
        Vpl vpl = as_disc(unpack_vpl(texelFetch(vpls, 2 * k), texelFetch(vpls, 2 * k + 1)));
        irradiance += vpl.strength * received_factor(k, vpl, receiver);
    }
}

#endif
