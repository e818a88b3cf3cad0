#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/emissive_points.glsl"
#include "lib/emitter_hits.glsl"
#include "lib/emitters.glsl"
#include "lib/lights.glsl"
#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "lightmaps/texels.glsl"

// The irradiance that one texel receives from the lights, W/m², by shadow rays; those to punctual lights from four points of it, for their shadows are sharp:
//
//   E = Σ_punctual E⊥·cosθ·V + Σ_k L_e(y_k)·cosθ·V/(K·p_k)·w_k + π/M Σ_m L(ω_m)·w_m
//
// Light that has a map of its own goes into that one; all else into the rest's, behind those.
//
// y_k: K points of emissive surfaces drawn by power with density p_k (1/sr, seen from the texel); ω_m: M directions by the cosine, which find emissive surfaces too,
// and the sky. w: the power heuristic between the two.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Direct { vec4 direct[]; };

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint light_count;      // punctual
    uint emitter_count;    // emissive triangles
    uint sample_count;     // K, 0 where nothing is emissive
    uint direction_count;  // M, 0 where nothing is emissive and no sky shines
    float density_scale;
    vec3 sky;              // W/(m²·sr)
    uint own_maps;         // lights that have one, the first ones
    uint rest;             // 1: there is a map of the rest
} push;

const uint STREAM = 0xD17EC7u;

void keep(uint number, uint map, vec3 irradiance) {
    direct[map * push.texel_count + number] = vec4(is_finite(irradiance) ? irradiance : vec3(0.0), 1.0);
}

// One light, or point of an emissive surface: what comes of it where nothing is between, and the way there.
struct Lamp {
    vec3 irradiance;
    vec3 way;
    float end;
};

Lamp punctual(uint number, LightTexel texel, vec3 origin) {
    Light light = load_light(punctual_lights, number);
    Illumination illumination = illuminate(light, origin);
    bool directional = light.kind == LIGHT_DIRECTIONAL;
    return Lamp(
        illumination.irradiance * max(dot(texel.normal, illumination.to_light), 0.0),
        directional ? illumination.to_light : light.position_rs - origin, directional ? 3e38 : 1.0);
}

Lamp emissive(uint number, LightTexel texel, vec3 origin, uint seed) {
    vec4 random = sobol_sample(sobol, number, seed);
    Emitter emitter = pick_emitter(emissive_triangles, push.emitter_count, random.x);
    Triangle triangle = load_triangle(triangles, emitter.number);
    Material material = load_material(materials, triangle.material);
    EmissivePoint point = draw_emissive_point(triangle, random.yz);
    vec3 front = front_normal(triangle);
    vec3 way = point_of_triangle(triangle, point.place, front) - origin;
    float distance2 = max(dot(way, way), 1e-30);
    vec3 to_light = way * inversesqrt(distance2);
    float cosine = -dot(front, to_light);
    cosine = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? abs(cosine) : max(cosine, 0.0);
    float received = max(dot(texel.normal, to_light), 0.0);
    float density = point.density * push.density_scale * distance2 / max(cosine, 1e-9);
    float weight = power_heuristic(float(push.sample_count) * density, float(push.direction_count) * received * INVERSE_PI);
    float scale = cosine > 0.0 ? received * weight / (density * float(push.sample_count)) : 0.0;
    return Lamp(scale > 0.0 ? covered_radiance(triangle, material, point.place) * scale : vec3(0.0), way, 1.0);
}

// Points in the middles of a texel's quarters. Those that it does not see lie behind something, or beside the surface, and count for nothing.
struct Quarters {
    vec3 origins[4];
    vec4 weights;
};

Quarters quarters_of(LightTexel texel, vec3 origin) {
    Chart chart = load_chart(lightmap_charts, texel.triangle & ~TEXEL_BACK);
    Triangle triangle = load_triangle(triangles, texel.triangle & ~TEXEL_BACK);
    // How the point moves along the map's axes.
    mat2 edges = mat2(chart.corners[1] - chart.corners[0], chart.corners[2] - chart.corners[0]);
    float area = determinant(edges);
    mat2 weights = abs(area) > 1e-12 ? inverse(edges) : mat2(0.0);
    vec3 u = weights[0].x * triangle.edge1 + weights[0].y * triangle.edge2;
    vec3 v = weights[1].x * triangle.edge1 + weights[1].y * triangle.edge2;
    Quarters quarters;
    [[dont_unroll]] for (uint i = 0u; i < 4u; ++i) {
        vec3 way = 0.25 * (((i & 1u) == 0u ? -u : u) + (i < 2u ? -v : v));
        bool seen = !is_occluded(origin, way, 1.0);
        quarters.origins[i] = origin + way;
        quarters.weights[i] = seen ? 1.0 : 0.0;
    }
    float total = dot(quarters.weights, vec4(1.0));
    quarters.origins[0] = total > 0.0 ? quarters.origins[0] : origin;
    quarters.weights = total > 0.0 ? quarters.weights / total : vec4(1.0, 0.0, 0.0, 0.0);
    return quarters;
}

// What comes along a direction that was drawn by the cosine.
vec3 along(vec3 origin, vec3 direction, float cosine) {
    Hit hit = closest_hit(origin, direction, 3e38);
    if (hit.triangle == NO_TRIANGLE) {
        return push.sky;
    }
    float ratio = float(push.sample_count) / float(push.direction_count);
    return push.emitter_count > 0u ? weighted_radiance(hit, direction, cosine * INVERSE_PI, push.density_scale * ratio) : vec3(0.0);
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    LightTexel texel = load_light_texel(number);
    vec3 irradiance = vec3(0.0);
    bool valid = (texelFetch(lightmap_flags, int(number)).x & TEXEL_VALID) != 0u;
    [[dont_unroll]] for (uint map = 0u; map < push.own_maps && !valid; ++map) {
        keep(number, map, vec3(0.0));
    }
    if (valid) {
        vec3 origin = offset_ray_origin(texel.position, texel.face);
        uint seed = seed_of(number, STREAM);
        uint punctual_rays = 4u * push.light_count;
        Quarters quarters;
        if (push.light_count > 0u) {
            quarters = quarters_of(texel, origin);
        }
        [[dont_unroll]] for (uint i = 0u; i < punctual_rays + push.sample_count; ++i) {
            bool sharp = i < punctual_rays;
            vec3 start = sharp ? quarters.origins[i & 3u] : origin;
            Lamp lamp = sharp ? punctual(i >> 2, texel, start) : emissive(i - punctual_rays, texel, origin, seed);
            float weight = sharp ? quarters.weights[i & 3u] : 1.0;
            if (weight > 0.0 && max3(lamp.irradiance) > 0.0 && dot(texel.face, lamp.way) > 0.0
                && !is_occluded(start, lamp.way, lamp.end)) {
                irradiance += weight * lamp.irradiance;
            }
            if (i < 4u * push.own_maps && (i & 3u) == 3u) {
                keep(number, i >> 2, irradiance);
                irradiance = vec3(0.0);
            }
        }
        Frame frame = frame_around(texel.normal);
        vec3 found = vec3(0.0);
        [[dont_unroll]] for (uint i = 0u; i < push.direction_count; ++i) {
            vec3 local = sample_cosine_hemisphere(sobol_sample(sobol, i, seed_of(seed, 1u)).xy);
            vec3 direction = to_world(frame, local);
            found += dot(direction, texel.face) > 0.0 ? along(origin, direction, local.z) : vec3(0.0);
        }
        irradiance += found * (PI / max(float(push.direction_count), 1.0));
    }
    if (push.rest != 0u) {
        keep(number, push.own_maps, irradiance);
    }
}
