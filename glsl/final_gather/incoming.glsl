// What gather rays bring. The including file has the hierarchy (lib/bvh.glsl) and says in its push constants which `rays` these are.
#ifndef FINAL_GATHER_INCOMING
#define FINAL_GATHER_INCOMING

#include "groups/photon_map.glsl"
#include "lib/hit_albedo.glsl"
#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "final_gather/records.glsl"

// What a distance across the tangent plane counts for, squared.
const float ACROSS = 8.0;

struct Nearest {
    int place;   // in the list of points; −1: none
    float key;   // m²
};

// Looks at the points of one cell.
void look_at_cell(ivec3 cell, vec3 position, vec3 normal, inout Nearest nearest) {
    int bucket = int(bucket_of(cell, push.rays.bits));
    int first = int(texelFetch(map_starts, bucket).x);
    int end = first + int(texelFetch(map_lengths, bucket).x);
    [[dont_unroll]] for (int place = first; place < end; ++place) {
        uvec4 where = texelFetch(map_points, 2 * place);
        vec3 offset = uintBitsToFloat(where.xyz) - position;
        float above = dot(offset, normal);
        float key = dot(offset, offset) + ACROSS * above * above;
        if (dot(offset, offset) >= push.rays.radius * push.rays.radius || abs(above) >= 0.25 * push.rays.radius || key > nearest.key
            || dot(unpack_direction(where.w), normal) <= 0.5) {
            continue;
        }
        // Of two as near, the one of the smaller number, whatever the order of the list.
        if (key == nearest.key && texelFetch(map_points, 2 * place + 1).w > texelFetch(map_points, 2 * nearest.place + 1).w) {
            continue;
        }
        nearest = Nearest(place, key);
    }
}

// The irradiance of the point of the map that is nearest to a point of a surface, W/m²; none within r: no light comes there.
vec3 irradiance_near(vec3 position, vec3 normal) {
    float inverse_cell = 1.0 / push.rays.radius;
    ivec3 own = cell_of(position, inverse_cell);
    vec3 within = position - vec3(own) * push.rays.radius;
    bvec3 upwards = greaterThan(within, vec3(0.5 * push.rays.radius));
    ivec3 towards = mix(ivec3(-1), ivec3(1), upwards);
    Nearest nearest = Nearest(-1, 3e38);
    // The eight cells around it reach half a cell, the 27 a whole one.
    [[dont_unroll]] for (int number = 0; number < 8 + 27; ++number) {
        bool wide = number >= 8;
        if (wide && nearest.key <= 0.25 * push.rays.radius * push.rays.radius) {
            break;
        }
        int other = number - 8;
        ivec3 way = wide ? ivec3(other % 3, other / 3 % 3, other / 9) - 1 : ivec3(number & 1, number >> 1 & 1, number >> 2) * towards;
        vec3 gap = mix(vec3(0.0), mix(within, push.rays.radius - within, greaterThan(way, ivec3(0))), notEqual(way, ivec3(0)));
        if (dot(gap, gap) <= nearest.key) {
            look_at_cell(own + way, position, normal, nearest);
        }
    }
    return nearest.place < 0 ? vec3(0.0) : uintBitsToFloat(texelFetch(map_points, 2 * nearest.place + 1).xyz);
}

// What the diffuse lobe of the surface that a ray meets sends back along it, W/(m²·sr): ρ/π·E.
vec3 radiance_along(vec3 origin, vec3 direction) {
    Hit hit = closest_hit(origin, direction, 3e38);
    if (hit.triangle == NO_TRIANGLE) {
        return vec3(0.0);
    }
    Triangle triangle = load_triangle(triangles, hit.triangle);
    vec3 albedo = albedo_of_hit(triangle, hit);
    if (max3(albedo) <= 0.0) {
        return vec3(0.0);
    }
    vec3 face = front_normal(triangle);
    vec3 position = point_of_hit(triangle, hit.barycentric, face, origin, hit.distance * direction);
    return albedo * irradiance_near(position, dot(face, direction) < 0.0 ? face : -face) * INVERSE_PI;
}

// These rays' share of the irradiance of indirect light at a point, W/m²: E = ∫ L cosθ dω ≈ π/N Σ L(ω_i), ω_i drawn by the cosine.
vec3 irradiance_by_rays(vec3 origin, vec3 normal, vec3 face, uint seed) {
    Frame frame = frame_around(normal);
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = push.rays.first; i < push.rays.end; ++i) {
        vec3 direction = to_world(frame, sample_cosine_hemisphere(sobol_sample(sobol, i, seed).xy));
        if (dot(direction, face) > 0.0) {
            sum += radiance_along(origin, direction);
        }
    }
    return sum * (PI / float(push.rays.count));
}

#endif
