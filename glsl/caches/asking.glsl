// What the pixel of an invocation asks of the caches: the nodes around its surface.
#ifndef CACHES_ASKING
#define CACHES_ASKING

#include "groups/surface.glsl"
#include "caches/cascades.glsl"
#include "lib/pixel_grid.glsl"

// position_of_pixel() with the same bits in every program: which nodes a pixel reads must be those that it asked for.
vec3 asking_position(vec2 ndc, float pixel_depth) {
    precise vec3 across = ndc.x * camera.right_scaled + ndc.y * camera.down_scaled;
    precise vec3 parallel = camera.position_rs + across + camera.forward * (camera.near + (1.0 - pixel_depth) * camera.depth_range);
    precise vec3 central = camera.position_rs + (camera.forward + across) * (camera.near / pixel_depth);
    return camera.depth_range > 0.0 ? parallel : central;
}

struct Asking {
    bool asks;
    vec3 position_rs;
    int cascade;
    bool in_both;  // the next cascade too
};

Asking asking_of_pixel(Cascades cascades, ivec2 pixel, ivec2 size) {
    float pixel_depth = is_inside(pixel, size) ? texelFetch(depth, pixel, 0).x : 0.0;
    if (pixel_depth <= 0.0) {
        return Asking(false, vec3(0.0), 0, false);
    }
    vec3 position_rs = asking_position(ndc_of_pixel(pixel, size), pixel_depth);
    float next;
    int cascade = cascade_of(cascades, position_rs, next);
    return Asking(true, position_rs, cascade, next > 0.0);
}

#endif
