#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/sobol.glsl"
#include "lib/pixel_rays.glsl"
#include "particles/albedo.glsl"
#include "particles/found_home.glsl"
#include "particles/link_direction.glsl"
#include "particles/region_point.glsl"

// The irradiance of one region, W/m², with what is nearer than two spacings seen from its own point (contact shadows): particles stand for a spacing of surface
// and know of nothing that is smaller.
//
//   E(x) = ∫ L cosθ dω ≈ π/n² Σ_{k near} L(what ray k meets) + A(x) · F(x)
//
// with n×n rays spread by the cosine, F: the share of them that meet nothing near, A: the irradiance of what is far, as if nothing near stood before it, read
// from particles (gather.comp). What is behind near things is taken to be as bright as what is beside them. Where no particle around has anything near, A is E.

layout(local_size_x = 64) in;

layout(set = 0, binding = 2) uniform samplerBuffer radiance;  // of particles, W/(m²·sr)
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D far;  // A, packed normal
layout(set = 0, binding = 4, rgba32f) uniform image2D regions_irradiance;

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    ivec2 size;       // pixels
    int level_count;
    uint side;        // rays a side of the square of directions
} push;

void main() {
    RegionPoint point = region_point(region_of_invocation(), push.size, push.level_count);
    if (point.texel.x < 0) {
        return;
    }
    vec4 received = imageLoad(regions_irradiance, point.texel);
    vec3 beyond = imageLoad(far, point.texel).rgb;
    if (received.rgb == beyond) {
        return;
    }
    vec3 origin = pixel_ray_origin(point.position_rs, push.shift, point.geometric_normal);
    Frame frame = frame_around(point.normal);
    uint seed = seed_of(uint(point.texel.x), uint(point.texel.y));
    vec3 sum = vec3(0.0);
    uint free = 0u;
    [[dont_unroll]] for (uint ray = 0u; ray < push.side * push.side; ++ray) {
        vec3 direction = to_world(frame, cosine_direction(link_square(seed, ray, push.side)));
        if (dot(direction, point.geometric_normal) <= 0.0) {
            continue;
        }
        Hit hit = closest_hit(origin, direction, NEAR_SPACINGS * particle_spacing);
        bool is_near = hit.triangle != NO_TRIANGLE;
        if (is_near) {
            Triangle triangle = load_triangle(triangles, hit.triangle);
            // What no particle stands for is dark, and counts as far, as for links.
            is_near = has_diffuse_lobe(load_material(materials, triangle.material));
            if (is_near) {
                vec3 front = front_normal(triangle);
                vec3 met = point_of_hit(triangle, hit.barycentric, front, origin, hit.distance * direction);
                uint home = found_home(hit.triangle, hit.barycentric, front, met, direction, hit.distance);
                sum += home == NO_PARTICLE ? vec3(0.0) : texelFetch(radiance, int(home)).rgb;
            }
        }
        free += is_near ? 0u : 1u;
    }
    float rays = float(push.side * push.side);
    imageStore(regions_irradiance, point.texel, vec4(beyond * (float(free) / rays) + sum * (PI / rays), received.w));
}
