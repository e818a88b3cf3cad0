#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/emissive_cells.glsl"
#include "lib/emissive_points.glsl"
#include "lib/microfacet.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "particles/again.glsl"
#include "particles/arrivals.glsl"
#include "particles/events.glsl"
#include "particles/found_home.glsl"
#include "particles/link_direction.glsl"
#include "particles/places.glsl"
#include "particles/specular.glsl"

// One link of one particle: the particle that stands for what a ray meets, sent in one of n×n strata of the hemisphere by the cosine. Of each square
// of strata one link also serves for scattering: stratified as well, by fewer. Scattering follows mirrors and glass to the first diffuse surface (L D S D
// belongs to the flux of particles), and off a surface with both lobes it goes on as often as the specular one sends light on, with all of the flux: such a link
// has two ends. Gathering ends where the ray does: what it would find behind is a caustic.
//
// Links that escape or end on an emitter also bring its light to the particle's flux (arrivals.glsl); that of emitters is weighted against the points that
// emit.comp draws, by the balance heuristic (Veach & Guibas 1995): next to a lamp links find it, far from it points do.

//
// Where something moved, the links that this may concern (touched_links.comp) are traced again.

layout(local_size_x = 64) in;

layout(set = 0, binding = 1) buffer Links { uint links[]; };
layout(set = 0, binding = 2) buffer ScatterLinks { uint scatter_links[]; };  // first ends; where something is specular, all second ends behind
layout(set = 0, binding = 3) buffer Arrivals { uint arrivals[]; };
layout(set = 0, binding = 4) buffer Lost { uint lost[]; };
layout(set = 0, binding = 5) uniform usamplerBuffer head;
layout(set = 0, binding = 6) uniform usamplerBuffer again;

layout(push_constant, scalar) uniform Push {
    uint first;         // particle of the chunk
    uint count;         // particles of the chunk
    uint gather_side;   // strata a side
    uint scatter_side;
    uint second_ends;         // where they begin
    uint sky_shines;
    float density_scale;      // from a point's density among all lights to that among emissive triangles
    float emitter_samples;    // points of emissive surfaces that emit.comp draws for each particle
    float greatest_radiance;  // of any emissive surface, W/(m²·sr)
    uint again;               // 1: those links alone that are listed
    uint particle_count;
} push;

// What stands for the surface that the ray meets first, for the first diffuse one on its way, and for one that its reflection off that one meets.
struct Ends {
    uint gathered;
    uint first;
    uint second;
};

void add_sky(uint particle, vec3 share, uint events) {
    if (!is_counted(events)) {
        return;
    }
    uvec3 steps = uvec3(min(share, vec3(4.0)) * SKY_STEPS + 0.5);
    uint first = EVENT_LEVELS == 0u || events == 0u ? particle * arrival_words() : late_sky(push.particle_count, particle, events);
    atomicAdd(arrivals[first], steps.r);
    atomicAdd(arrivals[first + 1u], steps.g);
    atomicAdd(arrivals[first + 2u], steps.b);
}

// What the link brings of the light of the surface that it meets, if it does. `density`: of the link's direction times their number, 1/sr.
bool add_emission(uint particle, Triangle triangle, Material material, Hit hit, vec3 direction, float density) {
    float cosine = -dot(front_normal(triangle), direction);
    cosine = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? abs(cosine) : cosine;
    if (triangle.light_density <= 0.0 || cosine <= 0.0) {
        return false;
    }
    float points = emissive_density(triangle, hit.barycentric) * push.density_scale * push.emitter_samples * hit.distance * hit.distance / max(cosine, 1e-9);
    vec3 radiance = emissive_radiance(triangle, material, hit.barycentric) / push.greatest_radiance;
    vec3 share = clamp(radiance * (density / (density + points)), 0.0, 1.0) * EMISSION_STEPS;
    uint first = particle * arrival_words() + EMISSION_WORD;
    for (uint channel = 0u; channel < 3u; ++channel) {
        atomicAdd(arrivals[first + 2u * channel], uint(share[channel]));
        atomicAdd(arrivals[first + 2u * channel + 1u], uint(fract(share[channel]) * EMISSION_STEPS));
    }
    return true;
}

float uniform_of(uint seed) {
    return float(seed >> 8) / 16777216.0;
}

// How much more often than it carries light a ray goes on off the first surface, so that it carries less than all and some is left for surfaces beyond the
// second; how many times what goes on off such a surface may come to in the end.
const float LEFT_FOR_MORE = 1.25;
const float MOST_FOLLOWING = 4.0;

// `follows`: beyond the first surface.
Ends trace_link(uint particle, vec3 position, vec3 normal, vec3 face, vec3 direction, uint seed, bool follows) {
    Ends ends = Ends(DARK_LINK, DARK_LINK, DARK_LINK);
    if (dot(direction, face) <= 0.0) {
        return ends;
    }
    vec3 origin = offset_ray_origin(position, face);
    vec3 carried = vec3(1.0);
    float passed = 0.0;  // the chance that it has come to stand for a surface with both lobes before
    bool brings = false;
    [[dont_unroll]] for (uint event = 0u; event <= MOST_SPECULAR; ++event) {
        Hit hit = closest_hit(origin, direction, 3e38);
        if (hit.triangle == NO_TRIANGLE) {
            add_sky(particle, carried / (1.0 - passed), event);
            ends.gathered = event == 0u ? ESCAPED_LINK : bringing_light(ends.gathered, true);
            return ends;
        }
        Triangle triangle = load_triangle(triangles, hit.triangle);
        Material material = load_material(materials, triangle.material);
        vec3 front = front_normal(triangle);
        vec3 met = point_of_hit(triangle, hit.barycentric, front, origin, hit.distance * direction);
        if (HAS_EMITTERS != 0u && event == 0u) {
            float density = float(push.gather_side * push.gather_side) * max(dot(normal, direction), 0.0) * INVERSE_PI;
            brings = add_emission(particle, triangle, material, hit, direction, density);
        }
        if (has_diffuse_lobe(material)) {
            float random = uniform_of(seed_of(seed, 9u));
            // Behind mirrors the link stands for what they let through; where that passes it by, for what this surface's specular lobe passes on, or for nothing.
            bool arrives = event == 0u || random < passed + max3(carried);
            uint home = !arrives ? NO_PARTICLE : found_home(hit.triangle, hit.barycentric, front, met, direction, hit.distance);
            if (arrives && home == NO_PARTICLE) {
                atomicAdd(lost[1], 1u);
                return ends;
            }
            uint end = event == 0u ? home : arrives ? link_behind(home, event, carried, random - passed) : DARK_LINK;
            if (ends.first == DARK_LINK) {
                ends.first = end;
            } else {
                ends.second = end;
            }
            if (event == 0u) {
                ends.gathered = bringing_light(home, brings) | (hit.distance < NEAR_SPACINGS * particle_spacing ? NEAR_LINK : 0u);
            }
            if (event > 0u) {
                passed += max3(carried);
                if (arrives || passed >= 1.0) {
                    return ends;
                }
            }
        }
        if (SPECULAR_LOBES == 0u || !follows || (material.flags & MATERIAL_UNLIT) != 0u) {
            return ends;
        }
        vec4 random = sobol_sample(sobol, event, seed);
        Passage passage = pass_on(triangle, material, hit.barycentric, met, direction, hit.distance, random.xyz);
        carried *= passage.weight;
        // Off a surface with both lobes few go on, which then carry as much as the others.
        if (ends.first != DARK_LINK && passed == 0.0) {
            float chance = min(LEFT_FOR_MORE * max3(carried), 1.0);
            if (uniform_of(seed_of(seed, 11u)) >= chance) {
                return ends;
            }
            carried /= chance;
        }
        bool in_reach = passed == 0.0 || push.sky_shines != 0u || uniform_of(seed_of(seed, 9u)) < passed + MOST_FOLLOWING * max3(carried);
        if (!passage.goes_on || max3(carried) < 1e-3 || !in_reach) {
            return ends;
        }
        origin = passage.origin;
        direction = passage.direction;
    }
    return ends;
}

void main() {
    uint link_count = push.gather_side * push.gather_side;
    uint link = gl_GlobalInvocationID.x;
    uint own = gl_GlobalInvocationID.y;
    if (push.again != 0u) {
        uint number = number_again(head, again, push.count * link_count);
        link = number % link_count;
        own = number / link_count;
    }
    if (link >= link_count || own >= push.count) {
        return;
    }
    uint particle = push.first + own;
    uvec4 place = texelFetch(particle_places, int(particle));
    vec3 face = face_of_particle(particle_places, particle);
    vec3 normal = unpack_direction(place.w);
    vec3 direction = link_direction(particle, link, push.gather_side, normal);
    uint scatter = scatter_link_of(particle, link, push.gather_side, push.scatter_side);
    bool scatters = scatter != NO_SCATTER_LINK;
    bool follows = scatters || push.sky_shines != 0u;
    Ends ends = trace_link(particle, uintBitsToFloat(place.xyz), normal, face, direction, seed_of(particle, link), follows);
    links[own * link_count + link] = ends.gathered;
    if (scatters) {
        uint scatter_link = particle * push.scatter_side * push.scatter_side + scatter;
        scatter_links[scatter_link] = ends.first;
        if (SPECULAR_LOBES != 0u) {
            scatter_links[push.second_ends + scatter_link] = ends.second;
        }
    }
}
