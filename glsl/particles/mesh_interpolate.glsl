// The irradiance of indirect light at a spot of a tessellated surface, W/m²: linear between the radiance particles of its subtriangle (Chang et al. 4.3.3),
// where normal maps turn the surface for its own normal; where light may not be interpolated, what area particles have (irradiance.glsl). The including file binds
// `tessellation`, `particle_marks`, `marked_before`, `radiance_particles` and what irradiance.glsl asks for.
#ifndef PARTICLES_MESH_INTERPOLATE
#define PARTICLES_MESH_INTERPOLATE

#include "particles/irradiance.glsl"
#include "particles/mesh_found.glsl"
#include "particles/mesh_spots.glsl"
#include "particles/mesh_tessellation.glsl"

vec3 irradiance_at_spot(uvec4 spot, vec3 position, vec3 normal) {
    if (spot.x == NO_SPOT) {
        return spot.y != NO_AREA_PARTICLE ? irradiance_at(position, normal, spot.y) : vec3(0.0);
    }
    Tessellated t = load_tessellated(spot.x >> 1);
    RowPlace points[3] = points_of_subtriangle(t, spot.y);
    vec3 weights = weights_of_spot(spot);
    vec3 sum = vec3(0.0);
    vec3 normals = vec3(0.0);
    vec4 tangential = vec4(0.0);
    for (uint point = 0u; point < 3u; ++point) {
        uint particle = particle_at(t, points[point], spot.x & 1u);
        int place = int(place_among_marked(particle_marks, marked_before, particle));
        vec4 received = texelFetch(radiance_particles, place);
        sum += weights[point] * received.rgb;
        if (TURNS != 0u) {
            normals += weights[point] * normalize(unpack_direction_in_float_unnormalized(received.w));
            vec3 turn = texelFetch(radiance_particles, textureSize(radiance_particles) / 2 + place).xyz;
            tangential += weights[point] * luminance(received.rgb) * vec4(turn, 1.0);
        }
    }
    return TURNS == 0u ? sum : sum * turned(normals, tangential.xyz / max(tangential.w, 1e-30), normal);
}

#endif
