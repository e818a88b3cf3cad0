// Where on the image a photon's disc may be seen, and how large a pixel is there.
#ifndef PHOTON_SPLAT_EXTENT
#define PHOTON_SPLAT_EXTENT

#include "lib/scene.glsl"
#include "photon_splat/lattice.glsl"

struct Extent {
    vec2 center;  // splat coordinates
    vec2 radius;  // half width and height of a rectangle that holds all that the disc lights; 0: it lights nothing
};

// Of points at most `radius` from `position` in the plane of `normal` and at most `height` off that plane.
//
// Perspective: x = p_x/p_z. A point p + δ is seen |δ·v|/(p_z(p_z + δ_z)) away along x, v = p_z·X − p_x·Z: the bound takes the
// largest |δ·v| and the smallest p_z + δ_z, which is at least the near plane's distance.
Extent disc_extent(Camera camera, vec3 position, vec3 normal, float radius, float height, ivec2 image_size, int downscale) {
    vec3 offset = position - camera.position_rs;
    vec2 lengths = vec2(length(camera.right_scaled), length(camera.down_scaled));
    vec3 axes[2] = { camera.right_scaled / lengths.x, camera.down_scaled / lengths.y };
    vec2 pixels = 0.5 * vec2(image_size) / lengths;
    float along = dot(offset, camera.forward);
    vec2 across = vec2(dot(offset, axes[0]), dot(offset, axes[1]));
    float along_normal = dot(normal, camera.forward);
    float depth = radius * sqrt(max(1.0 - along_normal * along_normal, 0.0)) + height * abs(along_normal);
    bool perspective = camera.depth_range <= 0.0;
    float behind = perspective ? max(along, 1e-30) : 1.0;
    float nearest = perspective ? max(along - depth, camera.near) : 1.0;

    vec2 center = 0.5 * vec2(image_size) + pixels * across / behind;
    vec2 reach;
    for (int axis = 0; axis < 2; ++axis) {
        vec3 v = perspective ? along * axes[axis] - across[axis] * camera.forward : axes[axis];
        float v_along_normal = dot(v, normal);
        float widest = radius * sqrt(max(dot(v, v) - v_along_normal * v_along_normal, 0.0)) + height * abs(v_along_normal);
        reach[axis] = pixels[axis] * widest / (behind * nearest);
    }
    Extent extent;
    extent.center = splat_coordinates(center, downscale);
    extent.radius = reach / float(downscale) + (downscale > 1 ? 0.5 : 0.0) + 1e-3;
    if (perspective && along < 0.25 * camera.near) {
        // The centre has no place on the image; the disc may still reach before the near plane.
        extent = Extent(0.5 * vec2(image_size) / float(downscale), vec2(1e9));
    }
    vec2 size = vec2(lattice_size(image_size, downscale));
    bool outside = any(lessThan(extent.center + extent.radius, vec2(0.0)))
        || any(greaterThan(extent.center - extent.radius, size)) || (perspective && along + depth < camera.near);
    extent.radius = outside ? vec2(0.0) : extent.radius;
    return extent;
}

#endif
