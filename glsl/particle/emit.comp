#version 460
#include "lib/prelude.glsl"
#include "groups/light_targets.glsl"
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
// so that the flux of all paths is N times what all lights send out. A share of the paths is sent to points of triangles that gather
// light (src/frame/rays/targets.rs) instead of by p(ω); what both carry is changed for it where they arrive (path/scatter.comp).
// Lights with a range send none: their light ends where no path would. Of a directional light only what falls within R of the scene's
// middle counts (lib/parallel_light.glsl).

layout(local_size_x = 64) in;

// 1: surfaces lie beyond R, which may hide a directional light.
layout(constant_id = 0) const uint FAR_SURFACES = 0u;

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "lib/emissive_points.glsl"
#include "lib/parallel_light.glsl"

layout(push_constant, scalar) uniform Push {
    uint emitter_count;
    uint first_path;     // of this wave in its sample
    uint path_count;     // in this wave
    uint seed;           // of the sample
    float light_paths;   // N: light paths a sample
    float radius;        // R, m
    vec3 middle;         // of the scene
    uint target_count;
    float target_share;  // of the paths
} push;

struct Start {
    vec3 origin;
    vec3 direction;
    vec3 flux;
    float cosine;        // at the light; −1: a beam that does not spread
    float ratio;         // D of mis.glsl at the first vertex, up to d²/|cos| (|cos| for a beam)
    float next_density;  // of next-event estimation on the light, 1/m²; none: beyond any
};

// Where a path is sent.
struct Target {
    bool wanted;      // false: wherever the light goes
    uint triangle;
    vec3 position_rs;
};

Target pick_target(float choice, float pick, vec2 random) {
    if (push.target_count == 0u || choice >= push.target_share) {
        return Target(false, 0u, vec3(0.0));
    }
    uint number = pick_emitter(targets, push.target_count, pick).number;
    Triangle triangle = load_triangle(triangles, number);
    return Target(true, number, point_of_triangle(triangle, place_in_triangle(random), front_normal(triangle)));
}

// From the disc of radius R before the scene. A target that the disc does not light gets nothing.
Start start_of_beam(Light light, float probability, Target target, vec2 random) {
    vec3 start = point_of_disc(frame_around(light.direction), push.middle, push.radius, random);
    bool inside = true;
    if (target.wanted) {
        vec3 from_middle = target.position_rs - push.middle;
        inside = is_behind_disc(from_middle, light.direction, push.radius * push.radius);
        start = target.position_rs - (dot(from_middle, light.direction) + DISC_DISTANCE * push.radius) * light.direction;
    }
    if (FAR_SURFACES != 0u && inside) {
        inside = !is_occluded(start, -light.direction, 3e38);
    }
    float area = PI * push.radius * push.radius;
    vec3 flux = inside ? light.intensity * (area / probability) : vec3(0.0);
    return Start(start, light.direction, flux, -1.0, area / push.light_paths, 1e38);
}

Start start_at_punctual(Emitter emitter, Target target, vec4 random) {
    Light light = load_light(punctual_lights, emitter.number);
    if (light.kind == LIGHT_DIRECTIONAL) {
        return start_of_beam(light, emitter.probability, target, random.xy);
    }
    Frame frame = frame_around(light.direction);
    // Uniform in the cone, or over the sphere.
    float depth = light.kind == LIGHT_SPOT ? 1.0 + light.spot_offset / light.spot_scale : 2.0;
    float cosine = 1.0 - depth * random.x;
    float azimuth = 2.0 * PI * random.y;
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec3 direction = to_world(frame, vec3(sine * cos(azimuth), sine * sin(azimuth), cosine));
    direction = target.wanted ? normalize_or(target.position_rs - light.position_rs, direction) : direction;
    float density = 0.5 * INVERSE_PI / max(depth, 1e-9);
    vec3 flux = light.range > 0.0 ? vec3(0.0) : radiant_intensity(light, direction) / (density * emitter.probability);
    return Start(light.position_rs, direction, flux, 1.0, 1.0 / (push.light_paths * density), 1e38);
}

Start start_at_triangle(Emitter emitter, Target target, vec2 place_random, vec4 random) {
    Triangle triangle = load_triangle(triangles, emitter.number);
    Material material = load_material(materials, triangle.material);
    bool both_sides = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u;
    EmissivePoint point = draw_emissive_point(triangle, place_random);
    vec3 normal = front_normal(triangle);
    vec3 position = point_of_triangle(triangle, point.place, normal);
    bool back = both_sides && (target.wanted ? dot(normal, target.position_rs - position) < 0.0 : random.z < 0.5);
    normal = back ? -normal : normal;
    vec3 origin = offset_ray_origin(position, normal);
    vec3 direction = to_world(frame_around(normal), sample_cosine_hemisphere(random.xy));
    direction = target.wanted ? normalize_or(target.position_rs - origin, normal) : direction;
    vec3 radiance = dot(normal, direction) > 0.0 ? covered_radiance(triangle, material, point.place) : vec3(0.0);
    float sides = both_sides ? 2.0 : 1.0;
    float cosine = max(dot(normal, direction), 1e-6);
    return Start(
        origin, direction, radiance * (PI * sides / point.density),
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
        Target target = pick_target(random.w, more.w, more.xy);
        Start start;
        if (emitter.is_triangle) {
            start = start_at_triangle(emitter, target, random.yz, more);
        } else {
            start = start_at_punctual(emitter, target, more);
        }
        wanted = max3(start.flux) > 0.0;
        new_rays[2u * path] = vec4(start.origin, start.cosine);
        new_rays[2u * path + 1u] = vec4(start.direction, start.next_density);
        new_states[path] = vec4(start.flux, start.ratio);
        new_flags[path] = FLAG_ALL_SPECULAR | (target.wanted ? target_mark(target.triangle) << TARGET_SHIFT : 0u);
        new_seeds[path] = uvec2(push.seed, index);
    }
    APPEND_TO_QUEUE(new_paths, path, wanted)
}
