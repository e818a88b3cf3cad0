#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/disc_surface.glsl"
#include "lib/exact_sum.glsl"
#include "lib/sobol.glsl"
#include "final_gather/records.glsl"

// The irradiance at one of the photons that were chosen as points of the map (Christensen 1999):
//
//   E = 1/(p π r²)·Σ Φ        W/m²
//
// over the photons within r of it, on the same side of the same surface: whose normal is at most 60° off, and which are within r/4 of the tangent plane. p is
// the share of the disc that is surface: rays are sent through it until four have met some, of k rays 1/p = k/4 on average.
//
// A point lies where a photon does, so that its disc has one photon too many. But a lookup takes the nearest point, so that around where it looks a disc is
// known to have no other one, which a mean of one would lie in: with photons of the density λ/m² the nearest is at a distance d with λπd² of mean 1, and the mean
// number of photons that it counts is 1 + λ(πr² − πd²), in all λπr². Where lookups end at r that holds for few photons too.
//
// Sums are integers of 64 bits: whatever the order of the photons, the same sum.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;   // as listed
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) uniform usamplerBuffer lengths;
layout(set = 0, binding = 3) uniform usamplerBuffer chosen;
layout(set = 0, binding = 4) uniform usamplerBuffer arguments;   // word 3: how many are chosen
layout(set = 0, binding = 5) writeonly buffer Points { MapRecord points[]; };
layout(set = 0, binding = 6) writeonly buffer Buckets { uint buckets[]; };  // of the points' own grid
layout(set = 0, binding = 7) buffer Counts { uint counts[]; };
layout(set = 0, binding = 8) buffer Tallies { uint tallies[]; };            // photons in their discs · rays

layout(push_constant, scalar) uniform Push {
    uint room;           // for points
    float radius;        // r, m; the grid of photons has cells of 2r, that of points of r
    float steps_a_watt;
    uint bits;           // of the grid of photons
    uint bits_of_points;
} push;

const uint HITS = 4u;
const uint MOST_RAYS = 64u;
const uint STREAM = 0x9015u;

Sum photons_around(vec3 position, vec3 normal) {
    float inverse_cell = 0.5 / push.radius;
    ivec3 low = cell_of(position - push.radius, inverse_cell);
    Sum sum = NO_SUM;
    [[dont_unroll]] for (uint corner = 0u; corner < 8u; ++corner) {
        int bucket = int(bucket_of(low + ivec3(corner & 1u, corner >> 1 & 1u, corner >> 2), push.bits));
        int first = int(texelFetch(starts, bucket).x);
        int end = first + int(texelFetch(lengths, bucket).x);
        [[dont_unroll]] for (int place = first; place < end; ++place) {
            uvec4 where = texelFetch(photons, 2 * place);
            vec3 offset = uintBitsToFloat(where.xyz) - position;
            if (dot(offset, offset) < push.radius * push.radius && abs(dot(offset, normal)) < 0.25 * push.radius
                && dot(unpack_direction(where.w), normal) > 0.5) {
                add(sum, uintBitsToFloat(texelFetch(photons, 2 * place + 1).xyz) * push.steps_a_watt);
            }
        }
    }
    return sum;
}

// 1/p
float rays_a_hit(vec3 position, Frame frame, uint number) {
    uint rays = 0u;
    uint hits = 0u;
    [[dont_unroll]] while (hits < HITS && rays < MOST_RAYS) {
        vec2 random = sobol_sample(sobol, rays, seed_of(number, STREAM)).xy;
        hits += meets_disc_surface(position, frame, push.radius, random) ? 1u : 0u;
        ++rays;
    }
    atomicAdd(tallies[1], rays);
    return float(rays) / float(max(hits, 1u));
}

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= min(texelFetch(arguments, 3).x, push.room)) {
        return;
    }
    int place = int(texelFetch(chosen, int(own)).x);
    uvec4 where = texelFetch(photons, 2 * place);
    uint number = texelFetch(photons, 2 * place + 1).w;
    vec3 position = uintBitsToFloat(where.xyz);
    vec3 normal = unpack_direction(where.w);
    Sum sum = photons_around(position, normal);
    float density = rays_a_hit(position, frame_around(normal), number) / (PI * push.radius * push.radius);
    vec3 flux = steps_of(sum) / push.steps_a_watt;
    points[own] = MapRecord(where, uvec4(floatBitsToUint(flux * density), number));
    uint home = bucket_of(cell_of(position, 1.0 / push.radius), push.bits_of_points);
    buckets[own] = home;
    atomicAdd(counts[home], 1u);
    atomicAdd(tallies[0], sum.count);
}
