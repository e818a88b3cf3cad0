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

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer received;  // the AIM
layout(set = 0, binding = 1) uniform usamplerBuffer list;     // texels to gather
layout(set = 0, binding = 2) uniform usamplerBuffer head;     // word 3: how many
layout(set = 0, binding = 3) buffer Gathered { vec4 gathered[]; };  // by texel

layout(push_constant, scalar) uniform Push {
    uint first;  // rays of this pass
    uint end;
    uint count;  // N
} push;

const uint STREAM = 0x6A7E2u;

vec3 radiance_along(vec3 origin, vec3 direction) {
    Hit hit = closest_hit(origin, direction, 3e38);
    return hit.triangle == NO_TRIANGLE ? vec3(0.0) : radiance_of_hit(hit, origin, direction, received);
}

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place >= texelFetch(head, 3).x) {
        return;
    }
    uint number = texelFetch(list, int(place)).x;
    vec3 sum = push.first > 0u ? gathered[number].rgb : vec3(0.0);
    if (is_valid(number)) {
        LightTexel texel = load_light_texel(number);
        vec3 origin = offset_ray_origin(texel.position, texel.face);
        Frame frame = frame_around(texel.normal);
        vec3 found = vec3(0.0);
        [[dont_unroll]] for (uint i = push.first; i < push.end; ++i) {
            vec3 direction = to_world(frame, sample_cosine_hemisphere(sobol_sample(sobol, i, seed_of(number, STREAM)).xy));
            if (dot(direction, texel.face) > 0.0) {
                found += radiance_along(origin, direction);
            }
        }
        sum += found * (PI / float(push.count));
    }
    gathered[number] = vec4(sum, 1.0);
}
