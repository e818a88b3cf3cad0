#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// The subtriangle that one pixel shows (mesh_seen.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, rgba32ui) writeonly uniform uimage2D spots;
layout(set = 0, binding = 1) buffer Marks { uint marks[]; };
layout(set = 0, binding = 2) uniform usamplerBuffer tessellation;

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

#include "particles/mesh_seen.glsl"

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(spots);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    uvec4 spot = NOTHING_SEEN;
    if (pixel_depth > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        if (max3(indirect_diffuse_albedo(point)) > 0.0) {
            spot = seen_subtriangle(
                position_rs + push.shift, point.geometric_normal, direction_to_eye(camera, position_rs), viewer_distance(camera, position_rs));
        }
    }
    imageStore(spots, pixel, spot);
}
