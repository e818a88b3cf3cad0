#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "lightmaps/gathered.glsl"

// One texel of the indirect illumination map (IIM; Larsen & Christensen 2004, section 4), by rays in place of a hemicube (glsl/hemicube/), some of
// them in each pass:
//
//   E = ∫ L cosθ dω ≈ π/N Σ (ρ_i/π)·E_AIM(y_i)        W/m²
//
// over N rays by the cosine, ρ_i the albedo of the diffuse lobe where ray i ends (lightmaps/gathered.glsl).
//
// A texel that was gathered of the same light before keeps the mean over all of its rounds. Their rays go on along one sequence, so that they fill each other's gaps.
// Maps of several lights are gathered by the same rays.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint MAPS = 1u;

layout(set = 0, binding = 0) uniform samplerBuffer received;  // the AIM
layout(set = 0, binding = 1) uniform usamplerBuffer list;     // texels to gather
layout(set = 0, binding = 2) uniform usamplerBuffer head;     // word 3: how many
layout(set = 0, binding = 3) buffer Gathered { vec4 gathered[]; };  // by map and texel; w: rounds

layout(push_constant, scalar) uniform Push {
    uint first;  // rays of this pass
    uint end;
    uint count;  // N
    uint texel_count;
} push;

const uint STREAM = 0x6A7E2u;

// Adds the radiance that comes along a ray to what was found of each map.
void add_radiance(vec3 origin, vec3 direction, inout vec3 found[MAPS]) {
    Hit hit = closest_hit(origin, direction, 3e38);
    vec3 lobe;
    Cell cell;
    if (hit.triangle != NO_TRIANGLE && sends_light_back(hit, origin, direction, lobe, cell)) {
        for (uint map = 0u; map < MAPS; ++map) {
            found[map] += lobe * light_of(cell, received, map * push.texel_count);
        }
    }
}

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place >= texelFetch(head, 3).x) {
        return;
    }
    uint number = texelFetch(list, int(place)).x;
    vec4 before = gathered[number];
    float rounds = push.first > 0u ? before.w : before.w + 1.0;
    float kept = push.first > 0u ? 1.0 : before.w / rounds;
    vec3 found[MAPS];
    for (uint map = 0u; map < MAPS; ++map) {
        found[map] = vec3(0.0);
    }
    if (is_valid(number)) {
        LightTexel texel = load_light_texel(number);
        vec3 origin = offset_ray_origin(texel.position, texel.face);
        Frame frame = frame_around(texel.normal);
        [[dont_unroll]] for (uint i = push.first; i < push.end; ++i) {
            uint ray = (uint(rounds) - 1u) * push.count + i;
            vec3 direction = to_world(frame, sample_cosine_hemisphere(sobol_sample(sobol, ray, seed_of(number, STREAM)).xy));
            if (dot(direction, texel.face) > 0.0) {
                add_radiance(origin, direction, found);
            }
        }
    }
    float scale = PI / (float(push.count) * rounds);
    for (uint map = 0u; map < MAPS; ++map) {
        uint place_in_map = map * push.texel_count + number;
        gathered[place_in_map] = vec4(gathered[place_in_map].rgb * kept + found[map] * scale, rounds);
    }
}
