#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/brdf.glsl"
#include "lib/microfacet.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "particles/home.glsl"
#include "particles/link.glsl"

// One link of one particle: the particle that stands for what a ray meets, sent in one of n×n strata of the hemisphere by the cosine. Of each square
// of strata one link also serves for scattering: stratified as well, by fewer.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer particle_faces;
layout(set = 0, binding = 1) writeonly buffer Links { uint links[]; };
layout(set = 0, binding = 2) buffer ScatterLinks { uint scatter_links[]; };
layout(set = 0, binding = 3) buffer Escaped { uint escaped[]; };  // links of each particle that meet nothing
layout(set = 0, binding = 4) buffer Lost { uint lost[]; };

layout(push_constant, scalar) uniform Push {
    uint first;         // particle of the chunk
    uint count;         // particles of the chunk
    uint gather_side;   // strata a side
    uint scatter_side;
} push;

uint link_in(vec3 position, vec3 face, vec3 direction) {
    if (dot(direction, face) <= 0.0) {
        return DARK_LINK;
    }
    vec3 origin = offset_ray_origin(position, face);
    Hit hit = closest_hit(origin, direction, 3e38);
    if (hit.triangle == NO_TRIANGLE) {
        return ESCAPED_LINK;
    }
    Triangle triangle = load_triangle(triangles, hit.triangle);
    Material material = load_material(materials, triangle.material);
    if (max3(lobes_of_material(material, material_factors(material, vec4(1.0))).diffuse_albedo) <= 0.0) {
        return DARK_LINK;
    }
    vec3 front = front_normal(triangle);
    vec3 met = point_of_hit(triangle, hit.barycentric, front, origin, hit.distance * direction);
    uint home = home_of(met, dot(front, direction) < 0.0 ? front : -front);
    if (home == NO_PARTICLE) {
        atomicAdd(lost[1], 1u);
        return DARK_LINK;
    }
    return home;
}

void main() {
    uint link = gl_GlobalInvocationID.x;
    uint link_count = push.gather_side * push.gather_side;
    uint own = gl_GlobalInvocationID.y;
    if (link >= link_count || own >= push.count) {
        return;
    }
    uint particle = push.first + own;
    uvec4 place = texelFetch(particle_places, int(particle));
    vec3 face = unpack_direction(texelFetch(particle_faces, int(particle)).x);
    uvec2 stratum = uvec2(link % push.gather_side, link / push.gather_side);
    uint random = seed_of(particle, link);
    vec2 jitter = vec2(random & 0xFFFFu, random >> 16) / 65536.0;
    vec2 square = (vec2(stratum) + jitter) / float(push.gather_side);
    vec3 direction = to_world(frame_around(unpack_direction(place.w)), cosine_direction(square));
    uint end = link_in(uintBitsToFloat(place.xyz), face, direction);
    links[own * link_count + link] = end;
    if (end == ESCAPED_LINK) {
        atomicAdd(escaped[particle], 1u);
    }
    uint block = push.gather_side / push.scatter_side;
    uvec2 scatter = stratum / block;
    uint chosen = seed_of(seed_of(particle, 0x5CA77E12u), scatter.y * push.scatter_side + scatter.x) % (block * block);
    uvec2 within = stratum - scatter * block;
    if (max(scatter.x, scatter.y) < push.scatter_side && within.y * block + within.x == chosen) {
        scatter_links[(particle * push.scatter_side + scatter.y) * push.scatter_side + scatter.x] = end;
    }
}
