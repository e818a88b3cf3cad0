// Which triangle the eye or a mirror's ray sees at a point. The point does not say; a ray over a small part of the way knows, whatever rounding did to the point:
// nothing stands before it. The including file has the hierarchy (lib/bvh.glsl).
#ifndef LIB_SEEN_TRIANGLE
#define LIB_SEEN_TRIANGLE

#include "lib/scene.glsl"
#include "lib/vectors.glsl"

// Shares of the distance: how far before the point the ray begins, and how far beside it the next one goes where a silhouette's rounding hid the surface.
const float BEFORE = 1.0 / 64.0;
const float BESIDE = 1.0 / 4096.0;
// An orthographic camera has no distance; the image's width takes its place, unless depths round by more.
const float DEPTH_SHARE = 1e-4;

// How far away a camera is, in that sense.
float viewer_distance(Camera camera, vec3 position_rs) {
    return camera.depth_range > 0.0 ? max(2.0 * length(camera.right_scaled), DEPTH_SHARE * camera.depth_range)
                                    : distance(camera.position_rs, position_rs);
}

// `to_viewer`: unit, the viewer `distance` away; `normal`: of the triangle.
Hit seen_hit(vec3 position, vec3 normal, vec3 to_viewer, float distance) {
    Hit hit = Hit(0.0, vec2(0.0), NO_TRIANGLE);
    vec3 aside = normalize_or(cross(to_viewer, normal), vec3(0.0));
    vec3 across = cross(aside, to_viewer);
    [[dont_unroll]] for (uint attempt = 0u; attempt < 5u && hit.triangle == NO_TRIANGLE; ++attempt) {
        vec3 way = (attempt & 1u) == 0u ? across : aside;
        vec3 beside = attempt == 0u ? vec3(0.0) : way * (attempt < 3u ? BESIDE : -BESIDE) * distance;
        hit = closest_hit(position + beside + to_viewer * (BEFORE * distance), -to_viewer, 2.0 * BEFORE * distance);
    }
    return hit;
}

#endif
