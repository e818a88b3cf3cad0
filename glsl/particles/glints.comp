#version 460
#include "lib/prelude.glsl"
#include "groups/light_targets.glsl"
#include "groups/particles.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/emissive_points.glsl"
#include "lib/emitters.glsl"
#include "lib/lights.glsl"
#include "lib/sobol.glsl"
#include "particles/events.glsl"
#include "particles/found_home.glsl"
#include "particles/specular.glsl"

// One photon from a light to a glossy triangle, by the tables of light paths (src/frame/rays/targets.rs), and on along its specular lobe, and those of what it
// meets then, to the first diffuse surface, whose particle takes its flux. With x drawn among the lights with probability (density) p(x) and y on the triangles
// with density p(y), N photons carry
//
//   φ = 1/N · I(x → y)·|cosθ_y|/(d²·p(x)·p(y))        W        (I = L_e·cosθ_x for an emissive surface, E for parallel light without d²)

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Glints { uint glints[]; };  // red, green, blue of each particle; where events are counted, behind them those of two, of three

layout(push_constant, scalar) uniform Push {
    uint photon_count;
    uint emitter_count;
    uint target_count;
    float steps_a_watt;
    uint particle_count;
} push;

const uint STREAMS = 0x611775u;

void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= push.photon_count) {
        return;
    }
    vec4 random = sobol_sample(sobol, photon, STREAMS);
    vec4 more = sobol_sample(sobol, photon, STREAMS + 1u);
    Emitter emitter = pick_emitter(emitters, push.emitter_count, random.x);
    Emitter aim = pick_emitter(targets, push.target_count, random.y);
    Triangle target = load_triangle(triangles, aim.number);
    vec3 front = front_normal(target);
    vec3 y = point_of_triangle(target, place_in_triangle(random.zw), front);
    float area = 0.5 * length(cross(target.edge1, target.edge2));
    float share = area / (aim.probability * emitter.probability * float(push.photon_count));

    // ---- from the light to y
    vec3 flux;
    vec3 x;
    vec3 direction;
    float length_to_y = 3e38;
    bool parallel = false;
    if (emitter.is_triangle) {
        Triangle source = load_triangle(triangles, emitter.number);
        Material material = load_material(materials, source.material);
        EmissivePoint point = draw_emissive_point(source, more.xy);
        vec3 source_front = front_normal(source);
        x = point_of_triangle(source, point.place, source_front);
        vec3 way = y - x;
        length_to_y = max(length(way), 1e-30);
        direction = way / length_to_y;
        float cosine = dot(source_front, direction);
        float source_area = 0.5 * length(cross(source.edge1, source.edge2));
        // Its density on the triangle over that of an even one.
        float density = point.density / max(source.light_density, 1e-30) / max(source_area, 1e-30);
        cosine = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? abs(cosine) : max(cosine, 0.0);
        flux = covered_radiance(source, material, point.place) * (cosine / (density * length_to_y * length_to_y));
        x = offset_ray_origin(x, dot(source_front, direction) < 0.0 ? -source_front : source_front);
    } else {
        Light light = load_light(punctual_lights, emitter.number);
        Illumination illumination = illuminate(light, y);
        direction = -illumination.to_light;
        parallel = light.kind == LIGHT_DIRECTIONAL;
        x = light.position_rs;
        length_to_y = parallel ? 3e38 : length(y - x);
        flux = illumination.irradiance;
    }
    flux *= share * abs(dot(front, direction));
    if (!(max3(flux) > 0.0)) {
        return;
    }
    vec3 side = dot(front, direction) < 0.0 ? front : -front;
    vec3 lifted = offset_ray_origin(y, side);
    bool hidden = is_occluded(lifted, parallel ? -direction : x - lifted, parallel ? 3e38 : 1.0);
    if (hidden) {
        return;
    }

    // ---- and on
    Triangle triangle = target;
    vec2 place = place_in_triangle(random.zw);
    vec3 met = y;
    [[dont_unroll]] for (uint event = 0u; event < MOST_SPECULAR && is_counted(event + 1u); ++event) {
        Material material = load_material(materials, triangle.material);
        vec4 drawn = sobol_sample(sobol, photon, STREAMS + 2u + event);
        Passage passage = pass_on(triangle, material, place, met, direction, length_to_y, drawn.xyz);
        flux *= passage.weight;
        if (!passage.goes_on || !(max3(flux) > 0.0)) {
            return;
        }
        Hit hit = closest_hit(passage.origin, passage.direction, 3e38);
        if (hit.triangle == NO_TRIANGLE) {
            return;
        }
        direction = passage.direction;
        length_to_y = hit.distance;
        place = hit.barycentric;
        triangle = load_triangle(triangles, hit.triangle);
        vec3 face = front_normal(triangle);
        met = point_of_hit(triangle, place, face, passage.origin, hit.distance * direction);
        Material next = load_material(materials, triangle.material);
        if ((next.flags & MATERIAL_UNLIT) != 0u) {
            return;
        }
        if (has_diffuse_lobe(next)) {
            uint home = found_home(hit.triangle, hit.barycentric, face, met, direction, hit.distance);
            uvec3 steps = uvec3(min(flux * push.steps_a_watt, vec3(1e8)) + 0.5);
            if (home != NO_PARTICLE && steps != uvec3(0u)) {
                uint first = 3u * (EVENT_LEVELS == 0u ? home : event * push.particle_count + home);
                atomicAdd(glints[first], steps.r);
                atomicAdd(glints[first + 1u], steps.g);
                atomicAdd(glints[first + 2u], steps.b);
            }
            return;
        }
    }
}
