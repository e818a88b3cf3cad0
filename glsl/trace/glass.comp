#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/hit_material.glsl"
#include "lib/pixels.glsl"

// What the surface at one pixel transmits, which the G-buffer does not know: a short ray along the line of sight finds its triangle again. The tint times the
// transmitted share, and the index of refraction behind the surface over that on the viewer's side; 1: a thin wall.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, rgba32f) writeonly uniform image2D glass;

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

// Of the distance to the camera: what the depth buffer's rounding may amount to, many times over.
const float NEAR = 1.0 / 4096.0;

vec4 transmission_at(vec3 position_rs, vec3 to_eye) {
    float away = camera.depth_range > 0.0 ? camera.depth_range : distance(camera.position_rs, position_rs);
    float reach = NEAR * away;
    Hit hit = closest_hit(position_rs + push.shift + to_eye * reach, -to_eye, 2.0 * reach);
    if (hit.triangle == NO_TRIANGLE) {
        return vec4(0.0, 0.0, 0.0, 1.0);
    }
    Triangle triangle = load_triangle(triangles, hit.triangle);
    Material material = load_material(materials, triangle.material);
    if (material.transmission <= 0.0 || (material.flags & MATERIAL_UNLIT) != 0u) {
        return vec4(0.0, 0.0, 0.0, 1.0);
    }
    vec3 weights = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    MaterialPoint point = material_factors(material, VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0));
    vec3 normal_texel = vec3(0.0, 0.0, 1.0);
    if ((material.flags & TEXTURES & MATERIAL_ALL_TEXTURES) != 0u) {
        vec4 sets = interpolated(corner_texcoords, triangle, weights);
        apply_textures(point, normal_texel, material, triangle.material, sets, Footprint(vec4(0.0), vec4(0.0)));
    }
    vec3 transmission = clamp(point.base_color.rgb * ((1.0 - point.metallic) * point.transmission), 0.0, 1.0);
    float relative_ior = 1.0;
    if (max3(transmission) > 0.0 && texelFetch(media, int(triangle.material)).w > 0.0) {
        relative_ior = dot(front_normal(triangle), to_eye) > 0.0 ? material.ior : 1.0 / material.ior;
    }
    return vec4(transmission, relative_ior);
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (!is_inside(pixel, imageSize(glass))) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec4 found = vec4(0.0, 0.0, 0.0, 1.0);
    if (pixel_depth > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, imageSize(glass)), pixel_depth);
        found = transmission_at(position_rs, direction_to_eye(camera, position_rs));
    }
    imageStore(glass, pixel, found);
}
