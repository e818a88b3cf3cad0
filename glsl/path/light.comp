#version 460
#include "lib/prelude.glsl"
#include "groups/paths.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/sobol.glsl"
#include "lib/emitters.glsl"
#include "path/mirrors.glsl"
#include "path/mis.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "path/vertex.glsl"

// Next-event estimation at one vertex: one point of one light, and what it would add if nothing is in between,
//
//   β · f(l, v) · L·(n_y·−l)⁺ / p_next        p_next = P(triangle) p(y) · d²/(n_y·−l), or P(light) with E⊥ in place of L
//
// for the diffuse and the specular lobe apart, each weighted against the other ways of finding the same path (mis.glsl). The ray to the
// light is left for `connect`.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer ConnectionRayBlock { vec4 connection_rays[]; };
layout(set = 0, binding = 1) writeonly buffer ConnectionLightBlock { vec4 connection_light[]; };
layout(set = 0, binding = 2) buffer QueueBlock { uint connections[]; };

#include "lib/ray_offset.glsl"
#include "lib/emissive_points.glsl"
#include "lib/parallel_light.glsl"

layout(push_constant, scalar) uniform Push {
    uint emitter_count;
    uint depth;           // vertices before this one
    LightPaths light_paths;
    float disc_area;      // m², across which light paths of a directional light start
    vec3 middle;          // of the scene
} push;

struct LightSample {
    vec3 to_light;
    float distance;         // up to which nothing may be in between
    vec3 irradiance;        // across the beam over the probability (punctual) or radiance over the density (triangle)
    float next;             // density at the vertex, 1/sr; 0: no other strategy but light paths finds it
    float emission_density; // of light paths that leave the light here wherever it goes, at the vertex across the beam: 1/m²
};

// Of light paths of a directional light, 1/m².
float beam_density(Light light, vec3 position_rs) {
    return is_behind_disc(position_rs - push.middle, light.direction, INVERSE_PI * push.disc_area) ? 1.0 / push.disc_area : 0.0;
}

LightSample sample_punctual(Emitter emitter, vec3 position_rs) {
    Light light = load_light(punctual_lights, emitter.number);
    Illumination illumination = illuminate(light, position_rs);
    bool directional = light.kind == LIGHT_DIRECTIONAL;
    float distance = directional ? 3e38 : length(light.position_rs - position_rs);
    float cone = light.kind == LIGHT_SPOT ? 0.5 * (1.0 + light.spot_offset / light.spot_scale) : 1.0;
    // Light paths leave out lights with a range (particle/emit.comp).
    float emission = light.range > 0.0 ? 0.0 : directional ? beam_density(light, position_rs) : 0.25 * INVERSE_PI / (max(cone, 1e-9) * max(distance * distance, 1e-30));
    return LightSample(illumination.to_light, distance, illumination.irradiance / emitter.probability, 0.0, emission);
}

LightSample sample_triangle(Emitter emitter, vec3 position_rs, vec2 random) {
    Triangle triangle = load_triangle(triangles, emitter.number);
    Material material = load_material(materials, triangle.material);
    EmissivePoint point = draw_emissive_point(triangle, random);
    vec3 front = front_normal(triangle);
    vec3 way = point_of_triangle(triangle, point.place, front) - position_rs;
    float distance2 = max(dot(way, way), 1e-30);
    vec3 to_light = way * inversesqrt(distance2);
    float cosine = -dot(front, to_light);
    bool both_sides = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u;
    cosine = both_sides ? abs(cosine) : max(cosine, 0.0);
    float next = point.density * distance2 / max(cosine, 1e-9);
    vec3 irradiance = cosine > 0.0 ? covered_radiance(triangle, material, point.place) / next : vec3(0.0);
    return LightSample(
        to_light, sqrt(distance2), irradiance, next,
        cosine * INVERSE_PI * (both_sides ? 0.5 : 1.0) / distance2);
}

// The balance heuristic for one lobe. `by_light`: the density of a light's path that finds the same, over that of this one.
float weight_of_next(LightSample light, float density, float by_light) {
    float hit = light.next > 0.0 ? density / light.next : 0.0;
    return 1.0 / (1.0 + hit + by_light);
}

LightSample light_from(Emitter emitter, vec3 position_rs, vec2 random) {
    if (emitter.is_triangle) {
        return sample_triangle(emitter, position_rs, random);
    }
    return sample_punctual(emitter, position_rs);
}

// `light_behind`: the light is on the other side of the surface than the viewer.
bool sample_light(uint path, out vec4 connection[2], out vec3 light_of_lobes[2], out bool light_behind) {
    light_behind = false;
    Vertex vertex = load_vertex(path_vertices, path);
    vec3 to_viewer = -texelFetch(path_rays, 2 * int(path) + 1).xyz;
    uvec2 seed = texelFetch(path_seeds, int(path)).xy;
    vec4 random = sobol_sample(sobol, seed.y, seed_of(seed.x, STREAM_LIGHT + 2u * push.depth));
    Emitter emitter = pick_emitter(emitters, push.emitter_count, random.x);
    if (PHOTONS != PHOTONS_NONE && (texelFetch(path_flags, int(path)).x & FLAG_ALL_SPECULAR) == 0u) {
        if (emitter.is_triangle || load_light(punctual_lights, emitter.number).range <= 0.0) {
            return false;
        }
    }
    LightSample light = light_from(emitter, vertex.position_rs, random.yz);
    float side = dot(vertex.geometric_normal, light.to_light);
    Frame frame = frame_around(vertex.normal);
    vec3 direction = to_local(frame, light.to_light);
    // The triangle and the shading normal must agree on which side the light is.
    if (max3(light.irradiance) <= 0.0 || side * direction.z <= 0.0 || (TRANSMISSIVE == 0u && side <= 0.0)) {
        return false;
    }
    vec3 viewer = local_viewer(frame, to_viewer);
    vec3 shares = lobe_shares(vertex.matter, viewer.z);
    LobeValue diffuse = diffuse_lobe(vertex.matter, viewer, direction, shares.x);
    LobeValue specular = specular_lobe(vertex.matter, viewer, direction, shares);
    vec2 by_light = vec2(0.0);
    if (LIGHT_PATHS != 0u && push.depth > 0u) {
        float sent = light_path_density(push.light_paths, light.emission_density * abs(side), vertex.target_density);
        by_light.x = lobe_density(vertex.matter, LOBE_DIFFUSE, direction, viewer);
        by_light.y = lobe_density(vertex.matter, LOBE_SPECULAR, direction, viewer);
        by_light *= vertex.ratio * vertex.reverse_geometry * push.light_paths.count * sent;
    }
    vec3 arriving = texelFetch(path_states, int(path)).rgb * light.irradiance;
    if (SPECULAR_LOBES != 0u) {
        uvec4 last = texelFetch(path_vertices, VERTEX_TEXELS * int(path) + 4);
        arriving *= vec3(unpackHalf2x16(last.z), unpackHalf2x16(last.w).x);
    }
    light_behind = side < 0.0;
    if (TRANSMISSIVE != 0u && light_behind) {
        // Radiance changes by the square of the ratio of indices, as in scatter.
        arriving /= vertex.matter.relative_ior * vertex.matter.relative_ior;
    }
    light_of_lobes[0] = arriving * diffuse.value * weight_of_next(light, diffuse.density, by_light.x);
    light_of_lobes[1] = arriving * specular.value * weight_of_next(light, specular.density, by_light.y);
    if (MIRRORS != 0u && is_beyond_mirrors(texelFetch(path_flags, int(path)).x, push.depth, vertex.matter.alpha)) {
        light_of_lobes[1] = vec3(0.0);
    }
    vec3 origin = offset_ray_origin(vertex.position_rs, side > 0.0 ? vertex.geometric_normal : -vertex.geometric_normal);
    // Aimed from where the ray starts: an emitter close by must not hide itself.
    bool far = light.distance > 1e37;
    vec3 way = far ? light.to_light : vertex.position_rs + light.to_light * light.distance - origin;
    float distance = length(way);
    connection[0] = vec4(origin, far ? light.distance : distance);
    connection[1] = vec4(way / max(distance, 1e-30), 0.0);
    return max3(light_of_lobes[0]) + max3(light_of_lobes[1]) > 0.0;
}

void main() {
    uint path = queued_path(alive_paths);
    vec4 connection[2];
    vec3 light_of_lobes[2];
    bool light_behind;
    bool shown = path != NO_PATH && (MIRRORS == 0u || is_within_mirrors(texelFetch(path_flags, int(path)).x, push.depth));
    bool wanted = shown && sample_light(path, connection, light_of_lobes, light_behind);
    if (wanted) {
        uint flags = texelFetch(path_flags, int(path)).x;
        bool split = push.depth == 1u && (flags & FLAG_FIRST_DIFFUSE) != 0u;
        bool behind = FOLLOWED != 0u && push.depth == 0u && light_behind;
        uint slot = behind ? SLOT_SPECULAR : push.depth == 0u ? SLOT_DIRECT : split ? SLOT_DIFFUSE : flags & FLAG_SLOT_MASK;
        if (SPECULAR_CAUSTICS != 0u && push.depth > 1u && slot == SLOT_CAUSTICS) {
            light_of_lobes[0] = vec3(0.0);
        }
        if (DIFFUSE_ALONE != 0u && push.depth > 0u) {
            light_of_lobes[1] = vec3(0.0);
        }
        if (FOLLOWED == FOLLOWED_UNMIRRORED && lights_mirrored(flags)) {
            light_of_lobes[1] = vec3(0.0);
        }
        connection_rays[2u * path] = connection[0];
        connection_rays[2u * path + 1u] = vec4(connection[1].xyz, uintBitsToFloat(slot));
        if (SPECULAR_LOBES == 0u) {
            connection_light[path] = vec4(light_of_lobes[0], 0.0);
        } else {
            connection_light[2u * path] = vec4(split ? light_of_lobes[0] : light_of_lobes[0] + light_of_lobes[1], 0.0);
            // What goes to the slot `caustics` besides.
            connection_light[2u * path + 1u] = vec4(split ? light_of_lobes[1] : vec3(0.0), 0.0);
        }
    }
    APPEND_TO_QUEUE(connections, path, wanted)
}
