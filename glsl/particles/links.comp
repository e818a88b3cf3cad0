#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/microfacet.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "particles/home.glsl"
#include "particles/link.glsl"
#include "particles/specular.glsl"

// One link of one particle: the particle that stands for what a ray meets, sent in one of n×n strata of the hemisphere by the cosine. Of each square
// of strata one link also serves for scattering: stratified as well, by fewer. Scattering follows mirrors and glass to the first diffuse surface (L D S D
// belongs to the flux of particles); gathering does not: what it would find there is a caustic.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer particle_faces;
layout(set = 0, binding = 1) writeonly buffer Links { uint links[]; };
layout(set = 0, binding = 2) buffer ScatterLinks { uint scatter_links[]; };
layout(set = 0, binding = 3) buffer Sky { uint sky[]; };  // links of each particle that meet nothing, and what mirrors and glass leave of others
layout(set = 0, binding = 4) buffer Lost { uint lost[]; };

layout(push_constant, scalar) uniform Push {
    uint first;         // particle of the chunk
    uint count;         // particles of the chunk
    uint gather_side;   // strata a side
    uint scatter_side;
} push;

// Where a link ends: what stands for the surface that its ray meets first, and for the first diffuse one behind mirrors and glass.
struct End {
    uint first;
    uint beyond;
};

End trace_link(uint particle, vec3 position, vec3 face, vec3 direction, uint seed) {
    End end = End(DARK_LINK, DARK_LINK);
    if (dot(direction, face) <= 0.0) {
        return end;
    }
    vec3 origin = offset_ray_origin(position, face);
    vec3 carried = vec3(1.0);
    [[dont_unroll]] for (uint event = 0u; event <= MOST_SPECULAR; ++event) {
        Hit hit = closest_hit(origin, direction, 3e38);
        if (hit.triangle == NO_TRIANGLE) {
            if (event == 0u) {
                return End(ESCAPED_LINK, ESCAPED_LINK);
            }
            uvec3 share = uvec3(min(carried, vec3(4.0)) * SKY_STEPS + 0.5);
            atomicAdd(sky[3u * particle], share.r);
            atomicAdd(sky[3u * particle + 1u], share.g);
            atomicAdd(sky[3u * particle + 2u], share.b);
            return end;
        }
        Triangle triangle = load_triangle(triangles, hit.triangle);
        Material material = load_material(materials, triangle.material);
        vec3 front = front_normal(triangle);
        vec3 met = point_of_hit(triangle, hit.barycentric, front, origin, hit.distance * direction);
        if (has_diffuse_lobe(material)) {
            // Behind mirrors the link stands for what they let through, or for nothing.
            bool arrives = event == 0u || float(seed_of(seed, 9u) >> 8) / 16777216.0 < dot(carried, vec3(1.0 / 3.0));
            if (!arrives) {
                return end;
            }
            uint home = home_of(met, dot(front, direction) < 0.0 ? front : -front);
            if (home == NO_PARTICLE) {
                atomicAdd(lost[1], 1u);
                return end;
            }
            return End(event == 0u ? home : DARK_LINK, home);
        }
        if (SPECULAR_LOBES == 0u || (material.flags & MATERIAL_UNLIT) != 0u) {
            return end;
        }
        vec4 random = sobol_sample(sobol, event, seed);
        Passage passage = pass_on(triangle, material, hit.barycentric, met, direction, hit.distance, random.xyz);
        carried *= passage.weight;
        if (!passage.goes_on || max3(carried) < 1e-3) {
            return end;
        }
        origin = passage.origin;
        direction = passage.direction;
    }
    return end;
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
    End end = trace_link(particle, uintBitsToFloat(place.xyz), face, direction, random);
    links[own * link_count + link] = end.first;
    if (end.first == ESCAPED_LINK) {
        atomicAdd(sky[3u * particle], SKY_STEPS);
        atomicAdd(sky[3u * particle + 1u], SKY_STEPS);
        atomicAdd(sky[3u * particle + 2u], SKY_STEPS);
    }
    uint block = push.gather_side / push.scatter_side;
    uvec2 scatter = stratum / block;
    uint chosen = seed_of(seed_of(particle, 0x5CA77E12u), scatter.y * push.scatter_side + scatter.x) % (block * block);
    uvec2 within = stratum - scatter * block;
    if (max(scatter.x, scatter.y) < push.scatter_side && within.y * block + within.x == chosen) {
        scatter_links[(particle * push.scatter_side + scatter.y) * push.scatter_side + scatter.x] = end.beyond;
    }
}
