// The irradiance of indirect light at a point of a surface, W/m²: a plane through the irradiances of the particles in the list of the point's particle,
// fitted by least squares with the weights of a kernel around the point (local linear regression: a mean alone would be pulled inwards at the edges of a
// surface), and kept between the smallest and the largest of them; where normal maps turn the surface, for its own normal (gather.comp). The including file binds
// list_lengths, lists and irradiance.
#ifndef PARTICLES_IRRADIANCE
#define PARTICLES_IRRADIANCE

#include "groups/particles.glsl"
#include "lib/octahedral.glsl"
#include "lib/color.glsl"
#include "lib/vectors.glsl"
#include "particles/lists.glsl"
#include "particles/places.glsl"

// Light from the side, from along the surface at last, brings so much more to what turns towards it at most.
const float MOST_TURNED = 3.0;

// 1: behind all irradiances are those that turned surfaces need.
layout(constant_id = 3) const uint TURNS = 0u;

// What a surface of normal n' receives over what particles around it do, whose normal is n on average.
float turned(vec3 particles_normal, vec3 tangential, vec3 normal) {
    float cosine = dot(normalize_or(particles_normal, normal), normal);
    return clamp(0.5 + 0.5 * cosine + dot(tangential, normal), 0.0, MOST_TURNED);
}

vec3 irradiance_at(vec3 position, vec3 normal, uint home) {
    uint list = texelFetch(list_lengths, int(home)).x;
    float radius = KERNEL_SPACINGS * spacing_of_particle(particle_places, home) * reach_of_list(list);
    // Moments of offsets (u, v) in units of the radius, and of irradiance with them.
    float weights = 0.0;
    vec2 first = vec2(0.0);
    vec3 second = vec3(0.0);
    vec3 sum = vec3(0.0);
    vec3 along_u = vec3(0.0);
    vec3 along_v = vec3(0.0);
    vec3 least = vec3(3e38);
    vec3 most = vec3(0.0);
    vec3 normals = vec3(0.0);
    vec4 tangential = vec4(0.0);  // and the weight
    vec3 tangent = normalize(abs(normal.x) > 0.7 ? vec3(-normal.y, normal.x, 0.0) : vec3(0.0, -normal.z, normal.y));
    vec3 bitangent = cross(normal, tangent);
    uint start = home * LIST_CAPACITY;
    uint end = start + length_of_list(list);
    [[dont_unroll]] for (uint place = start; place < end; ++place) {
        int particle = int(texelFetch(lists, int(place)).x);
        uvec4 record = texelFetch(particle_places, particle);
        vec3 way = (uintBitsToFloat(record.xyz) - position) / radius;
        float inside = max(1.0 - dot(way, way), 0.0);
        vec3 other_normal = unpack_direction(record.w);
        float weight = inside * inside * max(dot(other_normal, normal), 0.0);
        if (weight <= 0.0) {
            continue;
        }
        vec4 gathered = texelFetch(irradiance, particle);
        vec3 value = gathered.rgb;
        // By the share of the surface that the particle stands for.
        weight *= gathered.w;
        vec2 offset = vec2(dot(way, tangent), dot(way, bitangent));
        weights += weight;
        first += weight * offset;
        second += weight * vec3(offset.x * offset.x, offset.x * offset.y, offset.y * offset.y);
        sum += weight * value;
        along_u += weight * offset.x * value;
        along_v += weight * offset.y * value;
        least = min(least, value);
        most = max(most, value);
        if (TURNS != 0u) {
            normals += weight * other_normal;
            tangential += weight * luminance(value) * vec4(texelFetch(irradiance, textureSize(irradiance) / 2 + particle).xyz, 1.0);
        }
    }
    if (weights <= 0.0) {
        return texelFetch(irradiance, int(home)).rgb;
    }
    // The plane's value at the origin, by Cramer's rule.
    float scale = 1.0 / weights;
    float turn = TURNS == 0u ? 1.0 : turned(normals, tangential.xyz / max(tangential.w, 1e-30), normal);
    vec2 m = first * scale;
    vec3 s = second * scale;
    vec3 mean = sum * scale;
    vec3 spread = vec3(s.x - m.x * m.x, s.y - m.x * m.y, s.z - m.y * m.y);
    float determinant = spread.x * spread.z - spread.y * spread.y;
    // Points on a line or a single one know of no plane.
    if (determinant <= 1e-4) {
        return turn * mean;
    }
    vec3 cu = along_u * scale - mean * m.x;
    vec3 cv = along_v * scale - mean * m.y;
    vec3 slope_u = (cu * spread.z - cv * spread.y) / determinant;
    vec3 slope_v = (cv * spread.x - cu * spread.y) / determinant;
    return turn * clamp(mean - slope_u * m.x - slope_v * m.y, least, most);
}

#endif
