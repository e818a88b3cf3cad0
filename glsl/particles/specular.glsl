// Where light goes on that meets a surface's specular lobes: reflection or transmission, drawn by their shares.
#ifndef PARTICLES_SPECULAR
#define PARTICLES_SPECULAR

#include "groups/scene_rays.glsl"
#include "lib/lobes.glsl"
#include "lib/ray_offset.glsl"
#include "particles/albedo.glsl"
#include "particles/shading_normal.glsl"

// Specular events in a row at most.
const uint MOST_SPECULAR = 8u;

struct Passage {
    bool goes_on;
    vec3 origin;
    vec3 direction;
    vec3 weight;  // flux over what arrived
};

// `way`: unit, towards the surface; `length`: of the ray that came.
Passage pass_on(Triangle triangle, Material material, vec2 place, vec3 met, vec3 way, float length, vec3 random) {
    MaterialPoint point = textured_point(triangle, material, place);
    Lobes lobes = lobes_of_material(material, point);
    vec3 face = front_normal(triangle);
    bool front = dot(face, way) < 0.0;
    vec3 side = front ? face : -face;
    vec3 transmission = point.base_color.rgb * ((1.0 - point.metallic) * point.transmission);
    vec4 medium = TRANSMISSIVE != 0u ? texelFetch(media, int(triangle.material)) : vec4(0.0);
    float relative_ior = TRANSMISSIVE != 0u && max3(transmission) > 0.0 && medium.w > 0.0 ? (front ? material.ior : 1.0 / material.ior) : 1.0;
    Matter matter = Matter(
        lobes.diffuse_albedo, lobes.f0, lobes.f90, max(lobes.roughness * lobes.roughness, MINIMUM_ALPHA), transmission, relative_ior);
    Frame frame = frame_around(shading_normal(triangle, place, side));
    vec3 viewer = to_local(frame, -way);
    viewer = normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
    float matt = lobe_shares(matter, viewer.z).x;
    LobeSample drawn = sample_lobes(matter, viewer, mix(matt, 1.0, random.x), random.yz);
    Passage passage;
    passage.direction = to_world(frame, drawn.direction);
    float out_side = dot(side, passage.direction);
    passage.goes_on = drawn.density > 0.0 && drawn.lobe == LOBE_SPECULAR && out_side * drawn.direction.z > 0.0;
    passage.weight = drawn.weight * (1.0 - matt);
    if (TRANSMISSIVE != 0u && !front) {
        passage.weight *= exp(-medium.xyz * (medium.w * length));
    }
    passage.origin = offset_ray_origin(met, out_side > 0.0 ? side : -side);
    return passage;
}

#endif
