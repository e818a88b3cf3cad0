#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/octahedral.glsl"
#include "lib/ray_offset.glsl"
#include "lib/vectors.glsl"
#include "particles/grid.glsl"
#include "particles/headroom.glsl"
#include "particles/places.glsl"

// Notes of one particle whether something stands near it, and how much is free above it (headroom.glsl): another one above its tangent plane, or the
// underside of something, however low. Where neither is, nothing that is as large as its particles' spacing stands between it and the points that it stands for.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer sorted;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) uniform samplerBuffer spacing_of_all;
layout(set = 0, binding = 3) uniform usamplerBuffer numbers;
layout(set = 0, binding = 4) uniform usamplerBuffer places;
layout(set = 0, binding = 5) writeonly buffer Entries { uvec4 entries[]; };
layout(set = 0, binding = 6) uniform usamplerBuffer levels_of_all;

layout(push_constant, scalar) uniform Push { uint particle_count; } push;

// Cells that are looked through: around a particle whose spacing is many times another level's are more, and something is taken to stand near.
const int MOST_CELLS = 2048;
// Shares of the spacing: how far above the tangent plane others are, those that face another way too, whose underside this may be.
const float ABOVE = 0.1;
const float BARELY_ABOVE = 0.002;
const float OTHER_WAY = 0.5;  // cosine

// Whether a particle of a level stands near one of that spacing. A point is a spacing from its particle at most, and what stands between them has a particle that is
// one of its own spacings farther.
bool is_near(vec3 position, vec3 normal, float spacing, uint level, float widest) {
    uint bucket_count = uint(textureSize(starts)) - 1u;
    float reach = spacing + widest;
    ivec3 low = cell_of(position - reach, widest);
    ivec3 size = cell_of(position + reach, widest) - low + 1;
    bool crowded = size.x * size.y * size.z > MOST_CELLS;
    [[dont_unroll]] for (int number = 0; number < size.x * size.y * size.z && !crowded; ++number) {
        ivec3 cell = low + ivec3(number % size.x, number / size.x % size.y, number / (size.x * size.y));
        int bucket = int(bucket_of(cell, level, bucket_count));
        uint end = texelFetch(starts, bucket + 1).x;
        [[dont_unroll]] for (uint other = texelFetch(starts, bucket).x; other < end; ++other) {
            uvec4 other_place = texelFetch(sorted, int(other));
            vec3 way = uintBitsToFloat(other_place.xyz) - position;
            float above = dot(way, normal);
            bool stands = above > ABOVE * spacing
                          || (above > BARELY_ABOVE * spacing && dot(unpack_direction(other_place.w), normal) < OTHER_WAY);
            crowded = crowded || (stands && dot(way, way) < reach * reach);
        }
    }
    return crowded;
}

void main() {
    uint entry = gl_GlobalInvocationID.x;
    if (entry >= push.particle_count) {
        return;
    }
    uint particle = texelFetch(numbers, int(entry)).x;
    float spacing = spacing_of_particle(places, particle);
    uvec4 place = texelFetch(sorted, int(entry));
    vec3 position = uintBitsToFloat(place.xyz);
    vec3 normal = unpack_direction(place.w);
    float closest = texelFetch(spacing_of_all, 0).x;
    uint levels = texelFetch(levels_of_all, 0).x;
    bool crowded = false;
    [[dont_unroll]] for (uint level = 0u; level < levels && !crowded; ++level) {
        crowded = is_near(position, normal, spacing, level, widest_of_level(level, closest));
    }
    vec3 face = face_of_particle(places, particle);
    Hit above = closest_hit(offset_ray_origin(position, face), normal, 2.0 * LIFT * spacing);
    float halvings = 0.0;
    if (above.triangle != NO_TRIANGLE) {
        crowded = true;
        halvings = ceil(log2(max(2.0 * LIFT * spacing / max(above.distance, 1e-30), 1.0)));
    }
    uint level = crowded ? min(1u + uint(min(halvings, 100.0)), LEVELS) : 0u;
    uvec4 second = texelFetch(places, second_place(places, particle));
    entries[entry] = uvec4(place.xyz, with_headroom(place.w, second.w, level));
    entries[push.particle_count + entry] = uvec4(particle, second.z, 0u, 0u);
}
