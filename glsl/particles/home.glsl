// Which particle stands for a point of a surface: the nearest one whose normal agrees, off the tangent plane counting more, to which a short segment above the
// surface is free (one floor runs under many walls). How near it is counts in spacings of its own: where others lie closer together behind a thin wall, it is not
// lost beyond all of them, and if it is off the plane, it may be of another layer. The segment is tested only there, and where something stands near the particle
// (crowd.comp). It begins at a place above the point that nothing
// separates from it, and ends within what is free above the particle, so that it passes no plate, however close that is.
#ifndef PARTICLES_HOME
#define PARTICLES_HOME

#include "groups/particles.glsl"
#include "lib/octahedral.glsl"
#include "particles/grid.glsl"
#include "particles/headroom.glsl"
#include "particles/widths.glsl"

const uint NO_PARTICLE = 0xFFFFFFFFu;
// Cosine between the normals of a point and its particle.
const float SIMILAR = 0.7;
const float SIMILAR_AT_LEAST = 0.1;
const float NOT_OPPOSITE = -0.5;
// What a distance across the tangent plane counts for, squared.
const float ACROSS = 8.0;
const int ATTEMPTS = 12;
// Slope from which particles that are not among the closest are tested.
const float OTHER_LAYER = 0.02;

const uint NO_ENTRY = 0xFFFFFFFFu;

struct Neighbour {
    uint entry;
    float key;     // spacings²
    bool crowded;
};

// A place above a point, as high as a spacing says.
struct Lifted {
    vec3 position;
    vec3 way;        // unit, away from the surface
    float a_spacing; // how far along it lies
    float most;      // how far at most, m
};

vec3 position_of_entry(uint entry) {
    return uintBitsToFloat(texelFetch(particle_entries, int(entry)).xyz);
}

// Its number, the bits of its spacing.
uvec2 rest_of_entry(uint entry) {
    return texelFetch(particle_entries, textureSize(particle_entries) / 2 + int(entry)).xy;
}

uint particle_of_entry(uint entry) {
    return rest_of_entry(entry).x;
}

float spacing_of_entry(uint entry) {
    return uintBitsToFloat(rest_of_entry(entry).y);
}

// The nearer one of a neighbour and the nearest one of a level beyond `after` in the eight cells around the point, or, if `wide`, in 27. Of the eight those are left
// out that are farther than what was found.
Neighbour nearer_entry(Neighbour nearest, vec3 position, vec3 normal, uint level, float after, float similar, bool wide) {
    uint bucket_count = uint(textureSize(particle_starts)) - 1u;
    float spacing = widest_of_level(level, particle_spacing);
    ivec3 own = cell_of(position, spacing);
    // Towards which neighbours, and how far it is to them.
    vec3 within = position - vec3(own) * (CELL_SPACINGS * spacing);
    bvec3 upwards = greaterThan(within, vec3(0.5 * CELL_SPACINGS * spacing));
    vec3 away = mix(within, CELL_SPACINGS * spacing - within, upwards);
    ivec3 towards = mix(ivec3(-1), ivec3(1), upwards);
    // Other cells share the buckets.
    float reach2 = pow(2.0 * CELL_SPACINGS * spacing, 2.0) * 3.0;
    float widest2 = spacing * spacing;
    int count = wide ? 27 : 8;
    [[dont_unroll]] for (int number = 0; number < count; ++number) {
        ivec3 place = wide ? ivec3(number % 3, number / 3 % 3, number / 9) - 1 : ivec3(number & 1, number >> 1 & 1, number >> 2) * towards;
        vec3 gap = wide ? vec3(0.0) : away * vec3(abs(place));
        if (dot(gap, gap) > nearest.key * widest2) {
            continue;
        }
        int bucket = int(bucket_of(own + place, level, bucket_count));
        uint end = texelFetch(particle_starts, bucket + 1).x;
        [[dont_unroll]] for (uint entry = texelFetch(particle_starts, bucket).x; entry < end; ++entry) {
            uvec4 record = texelFetch(particle_entries, int(entry));
            vec3 way = uintBitsToFloat(record.xyz) - position;
            float above = dot(way, normal);
            uint width = packed_width(record.w);
            float own = spacing_of_width(width);
            float key = (dot(way, way) + ACROSS * above * above) / (own * own * particle_spacing * particle_spacing);
            if (key < nearest.key && key > after && dot(way, way) <= reach2 && dot(unpack_direction(record.w), normal) > similar) {
                bool off_plane = width > 0u && above * above > OTHER_LAYER * OTHER_LAYER * dot(way, way);
                nearest = Neighbour(entry, key, is_crowded(record.w) || off_plane);
            }
        }
    }
    return nearest;
}

Neighbour nearest_entry(vec3 position, vec3 normal, float after, float similar, bool wide) {
    Neighbour nearest = Neighbour(NO_ENTRY, 3e38, false);
    [[dont_unroll]] for (uint level = 0u; level < particle_levels; ++level) {
        nearest = nearer_entry(nearest, position, normal, level, after, similar, wide);
    }
    return nearest;
}

// Where segments to a particle end.
vec3 above_entry(uvec4 record, float spacing) {
    return uintBitsToFloat(record.xyz) + unpack_direction(record.w) * lift_of(record.w, spacing);
}

// Whether nothing stands between a place above a surface and a particle.
bool sees_entry(vec3 from, uint entry, float spacing) {
    vec3 way = above_entry(texelFetch(particle_entries, int(entry)), spacing) - from;
    return dot(way, way) <= 1e-12 * spacing * spacing || !is_occluded(from, way, 1.0);
}

// Places above a point from which one sees it along `way` (unit, away from the surface) from `distance` on.
Lifted lift_of_point(vec3 position, vec3 normal, vec3 way, float distance) {
    return Lifted(position, way, LIFT / clamp(dot(way, normal), 0.5, 1.0), 0.5 * distance);
}

vec3 lifted(Lifted lift, float spacing) {
    return lift.position + lift.way * min(lift.a_spacing * spacing, lift.most);
}

// NO_PARTICLE where there is none within reach. Where no segment is free, the nearest in space takes it: no flux is dropped.
uint home_among(vec3 position, vec3 normal, Lifted lift, float least_similar, bool any) {
    float after = -1.0;
    bool wide = false;
    uint nearest = NO_ENTRY;
    [[dont_unroll]] for (int attempt = 0; attempt < 2 * ATTEMPTS; ++attempt) {
        Neighbour found = nearest_entry(position, normal, after, wide ? least_similar : SIMILAR, wide);
        bool none = found.entry == NO_ENTRY;
        bool free = !none && !wide && !found.crowded;
        if (!none && !free) {
            float spacing = spacing_of_entry(found.entry);
            free = sees_entry(lifted(lift, spacing), found.entry, spacing);
        }
        if (free) {
            return particle_of_entry(found.entry);
        }
        nearest = nearest == NO_ENTRY && any ? found.entry : nearest;
        after = found.key;
        if (!wide && (none || attempt == ATTEMPTS - 1)) {
            wide = true;
            after = -1.0;
        } else if (none) {
            break;
        }
    }
    return nearest == NO_ENTRY ? NO_PARTICLE : particle_of_entry(nearest);
}

uint home_of(vec3 position, vec3 normal, Lifted lift) {
    return home_among(position, normal, lift, SIMILAR_AT_LEAST, true);
}

#endif
