#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/microfacet.glsl"

// Which area particles the estimation list of one radiance particle holds (Chang et al. 3.2): those of the candidates that it sees. Whether anything stands near
// area particles know (crowd.comp) of what has such itself; three rays along the surface know of mirrors too. Where nothing does, no candidate takes a ray. A
// list that would be empty is widened.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer tessellation;
layout(set = 0, binding = 1) uniform usamplerBuffer numbers;
layout(set = 0, binding = 2) uniform usamplerBuffer found;
layout(set = 0, binding = 3) writeonly buffer Slots { uvec4 slots[]; };
layout(set = 0, binding = 4) writeonly buffer Lengths { uint lengths[]; };
layout(set = 0, binding = 5) buffer Counts { uint counts[]; };  // entries, candidates for which there was no room, lists that were widened, empty ones

layout(push_constant, scalar) uniform Push { uint all_count; } push;  // 0: those found alone

#include "particles/home.glsl"
#include "particles/mesh_found.glsl"
#include "particles/mesh_particle.glsl"

// Slope from which candidates are tested where nothing stands near.
const float OFF_PLANE = 0.05;

// Of the three rays, in radii of the lists: at 60° off the way to a wall they meet what is one away.
const float AROUND = 2.0;

vec3 looks_from;
uvec2 held;
bool test_all;
vec3 own_normal;

void take_candidate(uint number, uint entry, uvec4 record, vec3 way) {
    bool tested = test_all || is_crowded(record.w) || abs(dot(way, own_normal)) > OFF_PLANE * length(way);
    if (!tested || sees_entry(looks_from, entry, particle_spacing)) {
        held[number >> 5] |= 1u << (number & 31u);
    }
}

#include "particles/mesh_candidates.glsl"

bool anything_near(vec3 from, vec3 normal, float radius) {
    Frame frame = frame_around(normal);
    bool near = false;
    [[dont_unroll]] for (uint i = 0u; i < 3u && !near; ++i) {
        float angle = (2.0 / 3.0) * PI * float(i);
        near = is_occluded(from, to_world(frame, vec3(cos(angle), sin(angle), 0.0) * (AROUND * radius)), 1.0);
    }
    return near;
}

void main() {
    uint slot = invocation_of_found();
    uint count = push.all_count > 0u ? push.all_count : texelFetch(found, 3).x;
    if (slot >= count) {
        return;
    }
    float spacing = particle_spacing;
    RadianceParticle particle = radiance_particle(push.all_count > 0u ? slot : texelFetch(numbers, int(slot)).x, spacing);
    float lift = free_lift(particle.position, particle.face, particle.normal, spacing);
    looks_from = particle.position + particle.normal * lift;
    own_normal = particle.normal;
    held = uvec2(0u);
    bool near = anything_near(looks_from, particle.normal, RADIUS_SPACINGS * spacing);
    uint widening = 0u;
    uint candidates = 0u;
    [[dont_unroll]] for (; widening <= MOST_WIDENINGS; ++widening) {
        // What stands farther away than two spacings says nothing of it to the candidates.
        test_all = near || widening > 0u;
        candidates = each_candidate(particle.position, particle.normal, widening);
        if (held != uvec2(0u)) {
            break;
        }
    }
    uint kept = uint(bitCount(held.x) + bitCount(held.y));
    slots[slot] = uvec4(held, kept | widening << 8, floatBitsToUint(lift));
    lengths[slot] = kept;
    atomicAdd(counts[0], kept);
    if (candidates > MOST_CANDIDATES) {
        atomicAdd(counts[1], candidates - MOST_CANDIDATES);
    }
    if (widening > 0u) {
        atomicAdd(counts[2], 1u);
    }
    if (kept == 0u) {
        atomicAdd(counts[3], 1u);
    }
}
