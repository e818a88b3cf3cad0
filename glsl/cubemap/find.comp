#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "cubemap/objects.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/pixels.glsl"
#include "lib/vectors.glsl"

// Whose map a pixel looks up: that of the object that it shows, which a short ray along the line of sight finds, as the G-buffer does not know it. A surface of no
// object takes the map of the object whose box is nearest, the smaller one of boxes that it lies in.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer objects;
layout(set = 0, binding = 1, r32ui) writeonly uniform uimage2D owners;  // 0: nothing specular; an object's number plus 1

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    uint object_count;
} push;

// Of the distance to the camera: what the depth buffer's rounding may amount to, many times over.
const float NEAR = 1.0 / 4096.0;

uint owner_of(vec3 position_rs, vec3 to_eye) {
    float away = camera.depth_range > 0.0 ? camera.depth_range : distance(camera.position_rs, position_rs);
    vec3 position = position_rs + push.shift;
    Hit hit = closest_hit(position + to_eye * (NEAR * away), -to_eye, 2.0 * NEAR * away);
    uint nearest = 0u;
    float least = 3e38;
    [[dont_unroll]] for (uint object = 0u; object < push.object_count; ++object) {
        int first = int(object * OBJECT_TEXELS);
        uint first_triangle = texelFetch(objects, first).w;
        uvec2 last = texelFetch(objects, first + 4).xy;
        if (hit.triangle != NO_TRIANGLE && hit.triangle >= first_triangle && hit.triangle < last.x) {
            return last.y + 1u;
        }
        float to_box = distance_to_box(objects, object, position - uintBitsToFloat(texelFetch(objects, first).xyz));
        if (to_box < least) {
            least = to_box;
            nearest = last.y + 1u;
        }
    }
    return nearest;
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(owners);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec4 lobe = pixel_depth > 0.0 && HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    uint owner = 0u;
    if (max(max3(lobe.rgb), lobe.a) > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        owner = owner_of(position_rs, direction_to_eye(camera, position_rs));
    }
    imageStore(owners, pixel, uvec4(owner));
}
