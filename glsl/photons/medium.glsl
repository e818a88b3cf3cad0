// Light on its way through a closed body.
#ifndef PHOTONS_MEDIUM
#define PHOTONS_MEDIUM

#include "lib/scene.glsl"

// What is left of light that meets a surface after `distance` metres (Beer & Lambert): only the back of a closed surface has a medium
// before it.
vec3 transmittance_behind(Material material, bool front, float distance) {
    if (front) {
        return vec3(1.0);
    }
    Medium medium = medium_of(material);
    return medium.is_closed ? exp(-medium.absorption * distance) : vec3(1.0);
}

#endif
