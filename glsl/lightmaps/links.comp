#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/hit_vertex.glsl"
#include "lib/sobol.glsl"
#include "lightmaps/links.glsl"
#include "lightmaps/lookup.glsl"

// The links of one texel: rays by the cosine, through mirrors and glass to the first surface that scatters them diffusely. Of the texels that stand for where one
// ends, it leads to one, drawn by their weights. A surface that answers in both ways is taken for one of them, by its albedos.
//
// What emissive surfaces and the sky send by way of specular lobes, E = π/N Σ w·L, is noted beside: no other pass finds it.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Links { uvec2 links[]; };
layout(set = 0, binding = 1) writeonly buffer Arrivals { vec4 arrivals[]; };  // W/m² of emissive surfaces · of a sky of 1 W/(m²·sr)

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint link_count;      // of each
    uint link_events;     // specular ones on the way of a link at most: bounces after all
    uint arrival_events;  // likewise of what is noted beside
} push;

const uint STREAM = 0x11CE5u;
const uint MOST_EVENTS = 8u;

struct Arrival {
    vec3 emitted;
    vec3 sky;
};

// Whether light that has so many specular events behind it is one of those that are noted.
bool is_arrival(uint event) {
    return event > 0u && event <= push.arrival_events;
}

// The link of one ray.
uvec2 follow(vec3 origin, vec3 direction, uint seed, inout Arrival arrival) {
    vec3 share = vec3(1.0);
    [[dont_unroll]] for (uint event = 0u; event < MOST_EVENTS && max3(share) > 0.0; ++event) {
        Hit hit = closest_hit(origin, direction, 3e38);
        if (hit.triangle == NO_TRIANGLE) {
            arrival.sky += is_arrival(event) ? share : vec3(0.0);
            break;
        }
        HitVertex vertex = vertex_of_hit(load_triangle(triangles, hit.triangle), hit, origin, direction, Footprint(vec4(0.0), vec4(0.0)));
        share *= vertex.transmittance;
        arrival.emitted += is_arrival(event) ? share * vertex.emitted : vec3(0.0);
        if (vertex.unlit) {
            break;
        }
        vec4 random = sobol_sample(sobol, event, seed);
        Frame frame = frame_around(vertex.normal);
        vec3 viewer = to_local(frame, -direction);
        viewer = normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
        float diffuse_share = lobe_shares(vertex.matter, viewer.z).x;
        if (random.x < diffuse_share) {
            if (event > push.link_events) {
                break;
            }
            vec3 albedo = indirect_diffuse_albedo(vertex.matter.diffuse_albedo, vertex.matter.f0, vertex.matter.f90);
            bool back = dot(front_normal(load_triangle(triangles, hit.triangle)), direction) > 0.0;
            Cell cell = texels_at(hit.triangle, hit.barycentric, back, vertex.position, vertex.face);
            vec4 below = vec4(cell.weights.x, cell.weights.x + cell.weights.y, 0.0, 0.0);
            below.z = below.y + cell.weights.z;
            below.w = below.z + cell.weights.w;
            if (below.w > 0.0) {
                float drawn = random.w * below.w;
                uint corner = drawn < below.x ? 0u : (drawn < below.y ? 1u : (drawn < below.z ? 2u : 3u));
                return uvec2(cell.texels[corner], pack_share(share * albedo / diffuse_share));
            }
            break;
        }
        LobeSample drawn = sample_lobes(vertex.matter, viewer, random.x, random.yz);
        direction = to_world(frame, drawn.direction);
        float side = dot(vertex.face, direction);
        if (drawn.density <= 0.0 || side * drawn.direction.z <= 0.0) {
            break;
        }
        share *= drawn.weight;
        origin = offset_ray_origin(vertex.position, side > 0.0 ? vertex.face : -vertex.face);
    }
    return uvec2(NO_TEXEL, 0u);
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    LightTexel texel = load_light_texel(number);
    bool reads = texel.triangle != NO_TEXEL && is_valid(number);
    vec3 origin = offset_ray_origin(texel.position, texel.face);
    Frame frame = frame_around(texel.normal);
    Arrival arrival = Arrival(vec3(0.0), vec3(0.0));
    [[dont_unroll]] for (uint i = 0u; i < push.link_count; ++i) {
        uvec2 link = uvec2(NO_TEXEL, 0u);
        vec3 direction = to_world(frame, sample_cosine_hemisphere(sobol_sample(sobol, i, seed_of(number, STREAM)).xy));
        if (reads && dot(direction, texel.face) > 0.0) {
            link = follow(origin, direction, seed_of(number * push.link_count + i, STREAM + 1u), arrival);
        }
        links[i * push.texel_count + number] = link;
    }
    float scale = PI / float(push.link_count);
    arrivals[2u * number] = vec4(arrival.emitted * scale, 0.0);
    arrivals[2u * number + 1u] = vec4(arrival.sky * scale, 0.0);
}
