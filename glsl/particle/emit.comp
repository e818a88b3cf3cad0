#version 460
#include "lib/prelude.glsl"
#include "groups/new_paths.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "lib/emitters.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"

// Starts one path from a light: a light by its share of the power, a point and a direction of it. It carries the flux
//
//   Φ = I(ω)/(P p(ω))   point, spot      E⊥·πR²/P   directional      π·L/(P p(y)) a side   emissive triangle        [W]
//
// so that the flux of all paths is N times what all lights send out. Lights with a range send none: their light ends where no
// path would. Of a directional light only what falls within R of the scene's middle counts (particle/parallel_light.glsl).

layout(local_size_x = 64) in;

// 1: surfaces lie beyond R, which may hide a directional light.
layout(constant_id = 0) const uint FAR_SURFACES = 0u;

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "lib/emissive_points.glsl"
#include "particle/parallel_light.glsl"

layout(push_constant, scalar) uniform Push {
    uint emitter_count;
    uint first_path;     // of this wave in its sample
    uint path_count;     // in this wave
    uint seed;           // of the sample
    float light_paths;   // N: light paths a sample
    float radius;        // R, m
    vec3 middle;         // of the scene
} push;

struct Start {
    vec3 origin;
    vec3 direction;
    vec3 flux;
    float cosine;        // at the light; −1: a beam that does not spread
    float ratio;         // D of mis.glsl at the first vertex, up to d²/|cos| (|cos| for a beam)
    float next_density;  // of next-event estimation on the light, 1/m²; none: beyond any
};

Start start_at_punctual(Emitter emitter, vec4 random) {
    Light light = load_light(punctual_lights, emitter.number);
    Frame frame = frame_around(light.direction);
    if (light.kind == LIGHT_DIRECTIONAL) {
        vec3 start = point_of_disc(frame, push.middle, push.radius, random.xy);
        float area = PI * push.radius * push.radius;
        vec3 flux = light.intensity * (area / emitter.probability);
        if (FAR_SURFACES != 0u && is_occluded(start, -light.direction, 3e38)) {
            flux = vec3(0.0);
        }
        return Start(start, light.direction, flux, -1.0, area / push.light_paths, 1e38);
    }
    // Uniform in the cone, or over the sphere.
    float depth = light.kind == LIGHT_SPOT ? 1.0 + light.spot_offset / light.spot_scale : 2.0;
    float cosine = 1.0 - depth * random.x;
    float azimuth = 2.0 * PI * random.y;
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec3 direction = to_world(frame, vec3(sine * cos(azimuth), sine * sin(azimuth), cosine));
    float density = 0.5 * INVERSE_PI / max(depth, 1e-9);
    vec3 flux = light.range > 0.0 ? vec3(0.0) : radiant_intensity(light, direction) / (density * emitter.probability);
    return Start(light.position_rs, direction, flux, 1.0, 1.0 / (push.light_paths * density), 1e38);
}

Start start_at_triangle(Emitter emitter, vec2 place_random, vec4 random) {
    Triangle triangle = load_triangle(triangles, emitter.number);
    Material material = load_material(materials, triangle.material);
    bool both_sides = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u;
    EmissivePoint point = draw_emissive_point(triangle, place_random);
    vec3 normal = front_normal(triangle);
    normal = both_sides && random.z < 0.5 ? -normal : normal;
    vec3 local = sample_cosine_hemisphere(random.xy);
    vec3 radiance = covered_radiance(triangle, material, point.place);
    float sides = both_sides ? 2.0 : 1.0;
    vec3 position = point_of_triangle(triangle, point.place, front_normal(triangle));
    float cosine = max(local.z, 1e-6);
    return Start(
        offset_ray_origin(position, normal), to_world(frame_around(normal), local), radiance * (PI * sides / point.density),
        cosine, sides * PI / (push.light_paths * cosine), point.density);
}

void main() {
    uint path = gl_GlobalInvocationID.x;
    bool wanted = path < push.path_count;
    if (wanted) {
        uint index = push.first_path + path;
        vec4 random = sobol_sample(sobol, index, seed_of(push.seed, STREAM_CAMERA));
        vec4 more = sobol_sample(sobol, index, seed_of(push.seed, STREAM_EMISSION));
        Emitter emitter = pick_emitter(emitters, push.emitter_count, random.x);
        Start start;
        if (emitter.is_triangle) {
            start = start_at_triangle(emitter, random.yz, more);
        } else {
            start = start_at_punctual(emitter, more);
        }
        wanted = max3(start.flux) > 0.0;
        new_rays[2u * path] = vec4(start.origin, start.cosine);
        new_rays[2u * path + 1u] = vec4(start.direction, start.next_density);
        new_states[path] = vec4(start.flux, start.ratio);
        new_flags[path] = FLAG_ALL_SPECULAR;
        new_seeds[path] = uvec2(push.seed, index);
    }
    APPEND_TO_QUEUE(new_paths, path, wanted)
}
