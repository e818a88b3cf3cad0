#version 460
#include "lib/prelude.glsl"
#include "lib/octahedral.glsl"
#include "lib/vectors.glsl"
#include "particles/crowded.glsl"
#include "particles/grid.glsl"

// Notes of one particle whether another one lies above its tangent plane nearby: where none does, nothing that is as large as the particles' spacing stands
// between it and the points that it stands for.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer sorted_places;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) uniform samplerBuffer spacing_of_all;
layout(set = 0, binding = 3) writeonly buffer Places { uvec4 places[]; };

layout(push_constant, scalar) uniform Push { uint particle_count; } push;

// Spacings: a point is one from its particle at most, and what stands between them has a particle this much farther.
const float REACH_SPACINGS = 2.0;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    float spacing = texelFetch(spacing_of_all, 0).x;
    uint bucket_count = uint(textureSize(starts)) - 1u;
    uvec4 place = texelFetch(sorted_places, int(particle));
    vec3 position = uintBitsToFloat(place.xyz);
    vec3 normal = unpack_direction(place.w);
    float reach = REACH_SPACINGS * spacing;
    ivec3 low = cell_of(position - reach, spacing);
    ivec3 size = cell_of(position + reach, spacing) - low + 1;
    bool crowded = false;
    [[dont_unroll]] for (int number = 0; number < size.x * size.y * size.z && !crowded; ++number) {
        ivec3 cell = low + ivec3(number % size.x, number / size.x % size.y, number / (size.x * size.y));
        int bucket = int(bucket_of(cell, bucket_count));
        uint end = texelFetch(starts, bucket + 1).x;
        [[dont_unroll]] for (uint other = texelFetch(starts, bucket).x; other < end; ++other) {
            vec3 way = uintBitsToFloat(texelFetch(sorted_places, int(other)).xyz) - position;
            crowded = crowded || (dot(way, way) < reach * reach && dot(way, normal) > ABOVE * spacing);
        }
    }
    places[particle] = uvec4(place.xyz, with_crowded(place.w, crowded));
}
