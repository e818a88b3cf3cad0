#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// Which radiance particles one pixel reads (mesh_views.glsl); if it sees none of them, the area particle that stands for its surface (seen_home.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, rgba32ui) uniform uimage2D spots;
layout(set = 0, binding = 1) readonly buffer Views { vec4 views[]; };
layout(set = 0, binding = 2) buffer Marks { uint marks[]; };
layout(set = 0, binding = 3) buffer Counts { uint counts[]; };
layout(set = 0, binding = 4) uniform usamplerBuffer subtriangle_marks;
layout(set = 0, binding = 5) uniform usamplerBuffer marked_before;

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

#include "particles/mesh_views.glsl"
#include "particles/seen_home.glsl"

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(spots);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    if (pixel_depth <= 0.0) {
        return;
    }
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    vec3 position = position_rs + push.shift;
    vec3 to_eye = direction_to_eye(camera, position_rs);
    vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
    uvec4 spot = imageLoad(spots, pixel);
    uvec4 read = read_spot(spot, lifted(lift_of_point(position, point.geometric_normal, to_eye, 3e38), particle_spacing));
    if (read.x == NO_SPOT && max3(indirect_diffuse_albedo(point)) > 0.0) {
        read.y = seen_home(position, point.geometric_normal, to_eye, 3e38);
        atomicAdd(counts[1], 1u);
    }
    if (read != spot) {
        imageStore(spots, pixel, read);
    }
}
