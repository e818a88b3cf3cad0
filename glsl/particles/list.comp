#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "particles/home.glsl"
#include "particles/lists.glsl"
#include "particles/moved.glsl"
#include "particles/widths.glsl"

// Lists the particles whose irradiance counts at points of one particle's catchment (the estimation lists of Chang et al. 3.2, at area particles): those
// within reach, of similar normals, near the tangent plane, and seen by it where anything stands near. Always in the same order.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Lists { uint lists[]; };
layout(set = 0, binding = 1) buffer Lengths { uint lengths[]; };  // and reaches (lists.glsl)
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };    // entries, lists of a shorter reach, entries for which there was no room
layout(set = 0, binding = 3) uniform usamplerBuffer touched;

layout(push_constant, scalar) uniform Push {
    uint particle_count;
    uint again;           // 1: those alone that something moved near
} push;

// Spacings: the kernel's radius and how far a point may be from its particle.
const float LIST_SPACINGS = KERNEL_SPACINGS + 1.0;
// Cosine between normals; share of the spacing off the tangent plane.
const float LIST_SIMILAR = 0.8;
const float LIST_ACROSS = 0.5;
// Shorter reaches that are tried, and by how much each is shorter than what evenly spread particles would take.
const uint SHORTENINGS = 6u;
const float SHORTER = 0.97;
// How much farther apart than those of a level particles reach as far in it as if they were of that level: the wider ones need not know all of many that are close.
const float CLOSER = 2.0;
// Slope from which entries are tested where nothing stands near.
const float OFF_PLANE = 0.05;

// Lists those of a level within `reach` behind the first `found` for which there is room, and returns how many there are with these.
uint list_level(uint found, uint first, vec3 position, vec3 normal, float reach, float across, uint level, float spacing) {
    uint bucket_count = uint(textureSize(particle_starts)) - 1u;
    ivec3 low = cell_of(position - reach, spacing);
    ivec3 size = cell_of(position + reach, spacing) - low + 1;
    [[dont_unroll]] for (int number = 0; number < size.x * size.y * size.z; ++number) {
        ivec3 cell = low + ivec3(number % size.x, number / size.x % size.y, number / (size.x * size.y));
        int bucket = int(bucket_of(cell, level, bucket_count));
        uint end = texelFetch(particle_starts, bucket + 1).x;
        [[dont_unroll]] for (uint other = texelFetch(particle_starts, bucket).x; other < end; ++other) {
            uvec4 other_place = texelFetch(particle_entries, int(other));
            vec3 other_position = uintBitsToFloat(other_place.xyz);
            vec3 way = other_position - position;
            float above = dot(way, normal);
            // Of several cells that share a bucket this one alone.
            if (dot(way, way) > reach * reach || cell_of(other_position, spacing) != cell || level_of_width(packed_width(other_place.w)) != level) {
                continue;
            }
            if (abs(above) <= across && dot(unpack_direction(other_place.w), normal) > LIST_SIMILAR) {
                if (found < LIST_CAPACITY) {
                    lists[first + found] = other;
                }
                ++found;
            }
        }
    }
    return found;
}

// Lists those within a share of the reach that a particle of that spacing has.
uint list_within(uint first, vec3 position, vec3 normal, float own_spacing, float share) {
    uint found = 0u;
    [[dont_unroll]] for (uint level = 0u; level < particle_levels; ++level) {
        float spacing = widest_of_level(level, particle_spacing);
        float reach = LIST_SPACINGS * min(own_spacing, CLOSER * spacing) * share;
        found = list_level(found, first, position, normal, reach, LIST_ACROSS * own_spacing, level, spacing);
    }
    return found;
}

void main() {
    uint entry = gl_GlobalInvocationID.x;
    if (entry >= push.particle_count) {
        return;
    }
    uint particle = particle_of_entry(entry);
    if (push.again != 0u && (touched_bits(touched, particle) & LIST_TOUCHED) == 0u) {
        return;
    }
    float spacing = spacing_of_entry(entry);
    uvec4 place = texelFetch(particle_entries, int(entry));
    vec3 position = uintBitsToFloat(place.xyz);
    vec3 normal = unpack_direction(place.w);
    uint first = particle * LIST_CAPACITY;
    uint reach_steps = REACH_STEPS;
    uint found = list_within(first, position, normal, spacing, 1.0);
    [[dont_unroll]] for (uint attempt = 0u; attempt < SHORTENINGS && found > LIST_CAPACITY; ++attempt) {
        float share = SHORTER * sqrt(float(LIST_CAPACITY) / float(found));
        reach_steps = max(uint(float(reach_steps) * share), 1u);
        found = list_within(first, position, normal, spacing, float(reach_steps) / float(REACH_STEPS));
    }
    uint listed = min(found, LIST_CAPACITY);
    vec3 from = above_entry(place, spacing);
    uint kept = 0u;
    [[dont_unroll]] for (uint i = 0u; i < listed; ++i) {
        uint other = lists[first + i];
        vec3 way = position_of_entry(other) - position;
        // Off the tangent plane may be another layer of thin things.
        bool tested = is_crowded(place.w) || abs(dot(way, normal)) > OFF_PLANE * length(way);
        if (!tested || other == entry || sees_entry(from, other, spacing_of_entry(other))) {
            lists[first + kept] = particle_of_entry(other);
            ++kept;
        }
    }
    lengths[particle] = list_word(kept, reach_steps);
    atomicAdd(counts[0], kept);
    atomicAdd(counts[1], reach_steps < REACH_STEPS ? 1u : 0u);
    if (found > listed) {
        atomicAdd(counts[2], found - listed);
    }
}
