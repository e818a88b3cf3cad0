// Surfaces cut out by their alpha, for kernels that trace rays: whether a hit is on what is left of the surface.
#ifndef LIB_CUTOUTS
#define LIB_CUTOUTS

#include "lib/coverage.glsl"

#define BVH_ACCEPTS_HITS

bool accepts_hit(uint index, vec2 barycentric) {
    if (ALPHA_MASKS == 0u) {
        return true;
    }
    Triangle triangle = load_triangle(triangles, index);
    return is_covered(triangle, load_material(materials, triangle.material), barycentric);
}

#endif
