// The area particles that one radiance particle's list may hold, always in the same order: those within reach, of similar normals, near the tangent plane.
// The including file has `void take_candidate(uint number, uint entry, uvec4 record, vec3 way)`, which gets each of the first MOST_CANDIDATES.
#ifndef PARTICLES_MESH_CANDIDATES
#define PARTICLES_MESH_CANDIDATES

// The radius, in spacings of the area particles: 12 lie within. It doubles with each widening.
const float RADIUS_SPACINGS = 2.0;
const uint MOST_WIDENINGS = 2u;
const uint MOST_CANDIDATES = 64u;
// Cosine between normals; share of the radius off the tangent plane.
const float CANDIDATE_SIMILAR = 0.8;
const float CANDIDATE_ACROSS = 0.25;

// How many there are.
uint each_candidate(vec3 position, vec3 normal, uint widening) {
    float spacing = particle_spacing;
    float reach = RADIUS_SPACINGS * spacing * exp2(float(widening));
    uint bucket_count = uint(textureSize(particle_starts)) - 1u;
    ivec3 low = cell_of(position - reach, spacing);
    ivec3 size = cell_of(position + reach, spacing) - low + 1;
    uint count = 0u;
    [[dont_unroll]] for (int number = 0; number < size.x * size.y * size.z; ++number) {
        ivec3 cell = low + ivec3(number % size.x, number / size.x % size.y, number / (size.x * size.y));
        int bucket = int(bucket_of(cell, 0u, bucket_count));
        uint end = texelFetch(particle_starts, bucket + 1).x;
        [[dont_unroll]] for (uint entry = texelFetch(particle_starts, bucket).x; entry < end; ++entry) {
            uvec4 record = texelFetch(particle_entries, int(entry));
            vec3 place = uintBitsToFloat(record.xyz);
            vec3 way = place - position;
            // Of several cells that share a bucket this one alone.
            bool near = dot(way, way) <= reach * reach && cell_of(place, spacing) == cell;
            if (near && abs(dot(way, normal)) <= CANDIDATE_ACROSS * reach && dot(unpack_direction(record.w), normal) > CANDIDATE_SIMILAR) {
                if (count < MOST_CANDIDATES) {
                    take_candidate(count, entry, record, way);
                }
                ++count;
            }
        }
    }
    return count;
}

#endif
