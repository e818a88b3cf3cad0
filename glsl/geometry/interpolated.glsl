// What a fragment gets of its triangle's corners, kept to what lies between them.
//
// A rasteriser interpolates by planes over the triangle's area on the screen. Of a sliver, and of any triangle seen edge-on, that area may
// round to zero while some pixel still counts as covered: the planes are then infinite, or steep enough to leave what the corners span
// (lavapipe: one texel of one such triangle made every sum over a light's view NaN). So each attribute comes with what it is at one corner,
// which does not depend on the area, and is held to the range that corners can span.
#ifndef GEOMETRY_INTERPOLATED
#define GEOMETRY_INTERPOLATED

#include "groups/geometry.glsl"
#include "lib/finite.glsl"
#include "lib/vectors.glsl"

// Corners hold 8-bit colours. `at_corner`: of one of the triangle's corners.
vec4 color_of_fragment(Instance instance, vec4 interpolated, vec4 at_corner) {
    if ((instance.flags & INSTANCE_HAS_COLORS) == 0u) {
        return vec4(1.0);
    }
    return clamp(is_finite(interpolated) ? interpolated : at_corner, 0.0, 1.0);
}

// A normal in object space, or `none` where it is not one that three unit vectors span.
vec3 normal_of_fragment(vec3 interpolated, vec3 none) {
    bool sound = is_finite(interpolated) && max3(abs(interpolated)) < 1.01;
    return sound ? interpolated : none;
}

#endif
