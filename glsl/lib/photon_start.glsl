// Where photons start, and the flux that they carry if one starts with that density:
//
//   Φ = I(ω)/(P p(ω))   point, spot      E⊥·πR²/P   directional      π·L/p(y) a side   emissive triangle      L·4π·πR²/P   sky     [W]
//
// Parallel light and the sky's start on a disc across their direction, as large as the sphere of radius R around all that matters.
#ifndef LIB_PHOTON_START
#define LIB_PHOTON_START

#include "lib/emissive_points.glsl"
#include "lib/emitters.glsl"
#include "lib/microfacet.glsl"
#include "lib/parallel_light.glsl"
#include "lib/ray_offset.glsl"

struct Start {
    vec3 origin;
    vec3 direction;
    vec3 flux;
    float range;  // of a light that ends, m; 0: none
};

// The sphere around all that matters.
struct Reach {
    vec3 middle;
    float radius;
    bool far_surfaces;  // surfaces lie beyond it, which may hide parallel light and the sky
};

Start start_on_disc(Reach reach, vec3 direction, vec3 flux, vec2 random) {
    vec3 origin = point_of_disc(frame_around(direction), reach.middle, reach.radius, random);
    bool hidden = reach.far_surfaces && is_occluded(origin, -direction, 3e38);
    return Start(origin, direction, hidden ? vec3(0.0) : flux, 0.0);
}

Start start_at_sky(Reach reach, vec3 sky, vec4 random, float probability) {
    float height = 1.0 - 2.0 * random.x;
    float azimuth = 2.0 * PI * random.y;
    vec3 direction = vec3(sqrt(max(1.0 - height * height, 0.0)) * vec2(cos(azimuth), sin(azimuth)), height);
    return start_on_disc(reach, direction, sky * (4.0 * PI * PI * reach.radius * reach.radius / probability), random.zw);
}

Start start_at_light(Reach reach, uint number, vec4 random, float probability) {
    Light light = load_light(punctual_lights, number);
    if (light.kind == LIGHT_DIRECTIONAL) {
        return start_on_disc(reach, light.direction, light.intensity * (PI * reach.radius * reach.radius / probability), random.xy);
    }
    // Uniform in the cone, or over the sphere.
    float depth = light.kind == LIGHT_SPOT ? 1.0 + light.spot_offset / light.spot_scale : 2.0;
    float cosine = 1.0 - depth * random.x;
    float azimuth = 2.0 * PI * random.y;
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec3 direction = to_world(frame_around(light.direction), vec3(sine * cos(azimuth), sine * sin(azimuth), cosine));
    return Start(light.position_rs, direction, radiant_intensity(light, direction) * (2.0 * PI * depth / probability), light.range);
}

// `chosen`: over the triangle's own density of points, that of its choice included.
Start start_at_triangle(uint number, vec2 place_random, vec4 random, float chosen) {
    Triangle triangle = load_triangle(triangles, number);
    Material material = load_material(materials, triangle.material);
    bool both_sides = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u;
    EmissivePoint point = draw_emissive_point(triangle, place_random);
    vec3 normal = front_normal(triangle);
    vec3 position = point_of_triangle(triangle, point.place, normal);
    normal = both_sides && random.z < 0.5 ? -normal : normal;
    vec3 direction = to_world(frame_around(normal), sample_cosine_hemisphere(random.xy));
    float sides = both_sides ? 2.0 : 1.0;
    vec3 flux = covered_radiance(triangle, material, point.place) * (PI * sides / (point.density * chosen));
    return Start(offset_ray_origin(position, normal), direction, dot(normal, direction) > 0.0 ? flux : vec3(0.0), 0.0);
}

#endif
