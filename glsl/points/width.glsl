// How wide the light of a photon, or of all photons of a pixel, is spread over the surface: an ellipse in the plane of its normal, as the symmetric matrix C of squared
// radii, m², in two axes that the normal alone decides. The means of matrices are matrices: photons of a pixel are summed as such.
#ifndef POINTS_WIDTH
#define POINTS_WIDTH

#include "photons/kept.glsl"
#include "points/reach.glsl"

struct Axes {
    vec3 x;
    vec3 y;
};

// Duff et al. 2017.
Axes axes_of(vec3 normal) {
    float side = normal.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + normal.z);
    float b = normal.x * normal.y * a;
    return Axes(vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x), vec3(b, side + normal.y * normal.y * a, -normal.y));
}

// No narrower than a pixel, no wider than the filter reaches on the screen.
float bounded_radius(float radius, float extent) {
    return clamp(radius, LEAST_RADIUS * extent, float(MOST_REACH) * extent);
}

// xx, yy, xy. `normal`: of the pixel's surface; `radius`: of all photons, m, or 0 where each has its own ellipse.
vec3 width_of(KeptPhoton photon, vec3 normal, float extent, float radius, float scale) {
    float larger = bounded_radius(radius > 0.0 ? radius : scale * photon.larger, extent);
    float smaller = bounded_radius(radius > 0.0 ? radius : scale * photon.smaller, extent);
    Axes axes = axes_of(normal);
    vec2 narrow = vec2(dot(photon.narrow_axis, axes.x), dot(photon.narrow_axis, axes.y));
    float off = dot(narrow, narrow);
    narrow = off > 1e-6 ? narrow * inversesqrt(off) : vec2(1.0, 0.0);
    float more = larger * larger - smaller * smaller;
    return vec3(larger * larger) * vec3(1.0, 1.0, 0.0) - more * vec3(narrow.x * narrow.x, narrow.y * narrow.y, narrow.x * narrow.y);
}

// The ellipse's larger radius: the root of the larger eigenvalue.
float largest_radius(vec3 width) {
    float middle = 0.5 * (width.x + width.y);
    float off = 0.5 * (width.x - width.y);
    return sqrt(middle + sqrt(off * off + width.z * width.z));
}

// The directions of the larger and of the smaller radius, each over its radius.
void axes_over_radii(vec3 width, vec3 normal, out vec3 first, out vec3 second) {
    Axes axes = axes_of(normal);
    float off = 0.5 * (width.x - width.y);
    float apart = sqrt(off * off + width.z * width.z);
    float middle = 0.5 * (width.x + width.y);
    // The direction of the larger radius has half the angle of (off, xy).
    vec2 doubled = apart > 1e-20 * middle ? vec2(off, width.z) / apart : vec2(1.0, 0.0);
    float cosine = sqrt(max(0.5 + 0.5 * doubled.x, 0.0));
    float sine = (doubled.y < 0.0 ? -1.0 : 1.0) * sqrt(max(0.5 - 0.5 * doubled.x, 0.0));
    first = (cosine * axes.x + sine * axes.y) * inversesqrt(middle + apart);
    second = (cosine * axes.y - sine * axes.x) * inversesqrt(max(middle - apart, 1e-6 * middle));
}

#endif
