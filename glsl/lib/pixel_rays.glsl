// Where rays from the surface at a pixel start. The scene that rays meet has an origin of its own: `shift` leads from the G-buffer's render space
// to that.
#ifndef LIB_PIXEL_RAYS
#define LIB_PIXEL_RAYS

#include "groups/surface.glsl"
#include "lib/ray_offset.glsl"

// A position from the depth buffer is off its surface by rounding of the depth, which is interpolated across the triangle: a few units in
// the last place of the distance.
const float DEPTH_SLACK = 1.0 / 131072.0;

vec3 pixel_ray_origin(vec3 position_rs, vec3 shift, vec3 normal) {
    float away = camera.depth_range > 0.0 ? camera.depth_range : distance(camera.position_rs, position_rs);
    return offset_ray_origin(position_rs + shift, normal) + normal * (DEPTH_SLACK * away);
}

#endif
