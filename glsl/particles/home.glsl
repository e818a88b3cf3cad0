// Which particle stands for a point of a surface: the nearest one whose normal agrees, off the tangent plane counting more, to which a short segment
// above the surface is free (one floor runs under many walls). The segment is tested only where some particle lies above the tangent plane: elsewhere
// nothing that is as large as the particles' spacing stands in between.
#ifndef PARTICLES_HOME
#define PARTICLES_HOME

#include "groups/particles.glsl"
#include "lib/octahedral.glsl"
#include "particles/grid.glsl"

const uint NO_PARTICLE = 0xFFFFFFFFu;
// Cosine between the normals of a point and its particle.
const float SIMILAR = 0.7;
const float SIMILAR_AT_LEAST = 0.1;
const float NOT_OPPOSITE = -0.5;
// Shares of the spacing.
const float ABOVE = 0.1;
const float LIFT = 0.15;
// What a distance across the tangent plane counts for, squared.
const float ACROSS = 8.0;
const int ATTEMPTS = 4;

struct Neighbour {
    uint particle;
    float key;     // m²
    bool crowded;  // something lies above the tangent plane nearby
};

float spacing_of_particles() {
    return particle_spacing;
}

vec3 position_of_particle(uint particle) {
    return uintBitsToFloat(texelFetch(particle_places, int(particle)).xyz);
}

// The nearest one beyond `after` in the cells `low` to `high`.
Neighbour nearest_particle(vec3 position, vec3 normal, float spacing, float after, float similar, int reach) {
    uint bucket_count = uint(textureSize(particle_starts)) - 1u;
    ivec3 low = reach == 0 ? cell_of(position - CELL_SPACINGS * 0.5 * spacing, spacing) : cell_of(position, spacing) - reach;
    int side = reach == 0 ? 2 : 2 * reach + 1;
    Neighbour nearest = Neighbour(NO_PARTICLE, 3e38, false);
    [[dont_unroll]] for (int number = 0; number < side * side * side; ++number) {
        ivec3 cell = low + ivec3(number % side, number / side % side, number / (side * side));
        int bucket = int(bucket_of(cell, bucket_count));
        uint end = texelFetch(particle_starts, bucket + 1).x;
        [[dont_unroll]] for (uint particle = texelFetch(particle_starts, bucket).x; particle < end; ++particle) {
            uvec4 place = texelFetch(particle_places, int(particle));
            vec3 way = uintBitsToFloat(place.xyz) - position;
            float above = dot(way, normal);
            float distance2 = dot(way, way);
            // Buckets hold other cells too.
            bool near = distance2 < 9.0 * spacing * spacing;
            nearest.crowded = nearest.crowded || (near && above > ABOVE * spacing);
            float key = distance2 + ACROSS * above * above;
            if (key < nearest.key && key > after && dot(unpack_direction(place.w), normal) > similar) {
                nearest.particle = particle;
                nearest.key = key;
            }
        }
    }
    return nearest;
}

// Whether nothing stands between a point and a particle, both lifted off their surfaces.
bool sees_particle(vec3 position, vec3 normal, uint particle, float spacing) {
    uvec4 place = texelFetch(particle_places, int(particle));
    vec3 from = position + normal * (LIFT * spacing);
    vec3 to = uintBitsToFloat(place.xyz) + unpack_direction(place.w) * (LIFT * spacing);
    vec3 way = to - from;
    return dot(way, way) <= 1e-12 * spacing * spacing || !is_occluded(from, way, 1.0);
}

// NO_PARTICLE where there is none within reach. Where no segment is free, the nearest in space takes it: no flux is dropped.
uint home_among(vec3 position, vec3 normal, float least_similar, bool any) {
    float spacing = spacing_of_particles();
    float after = -1.0;
    int reach = 0;
    uint nearest = NO_PARTICLE;
    [[dont_unroll]] for (int attempt = 0; attempt < 2 * ATTEMPTS; ++attempt) {
        Neighbour found = nearest_particle(position, normal, spacing, after, reach == 0 ? SIMILAR : least_similar, reach);
        bool none = found.particle == NO_PARTICLE;
        if (!none && ((reach == 0 && !found.crowded) || sees_particle(position, normal, found.particle, spacing))) {
            return found.particle;
        }
        nearest = nearest == NO_PARTICLE && any ? found.particle : nearest;
        after = found.key;
        if (reach == 0 && (none || attempt == ATTEMPTS - 1)) {
            reach = 1;
            after = -1.0;
        } else if (none) {
            return nearest;
        }
    }
    return nearest;
}

uint home_of(vec3 position, vec3 normal) {
    return home_among(position, normal, SIMILAR_AT_LEAST, true);
}

#endif
