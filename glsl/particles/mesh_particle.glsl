// A radiance particle as it looks for area particles. Corners of rooms lie in the planes of walls: it looks from a little inside of the triangle that it belongs to.
// The including file binds `tessellation` and includes lib/bvh.glsl.
#ifndef PARTICLES_MESH_PARTICLE
#define PARTICLES_MESH_PARTICLE

#include "lib/ray_offset.glsl"
#include "particles/headroom.glsl"
#include "particles/mesh_tessellation.glsl"
#include "particles/shading_normal.glsl"

struct RadianceParticle {
    vec3 position;
    vec3 face;    // unit, on its side
    vec3 normal;  // of shading, likewise
};

// Share of the area particles' spacing.
const float INWARDS = 0.02;

RadianceParticle radiance_particle(uint number, float spacing) {
    uint index = triangle_of_number(number, false, tessellated_triangle_count());
    Tessellated t = load_tessellated(index);
    uint local = number - t.first;
    uint sides = sides_of(t);
    vec2 place = place_of_particle(t, local / sides);
    Triangle triangle = load_triangle(triangles, index);
    vec3 front = front_normal(triangle);
    vec3 position = point_of_triangle(triangle, place, front);
    vec3 inwards = point_of_triangle(triangle, vec2(1.0 / 3.0), front) - position;
    float away = length(inwards);
    position += inwards * (min(0.5 * away, INWARDS * spacing) / max(away, 1e-30));
    vec3 face = local % sides == 1u ? -front : front;
    return RadianceParticle(position, face, shading_normal(triangle, place, face));
}

// How far above a surface segments may begin: no higher than half of what is free there.
float free_lift(vec3 position, vec3 face, vec3 normal, float spacing) {
    Hit above = closest_hit(offset_ray_origin(position, face), normal, 2.0 * LIFT * spacing);
    return above.triangle == NO_TRIANGLE ? LIFT * spacing : 0.5 * above.distance;
}

#endif
