#version 460
#include "lib/prelude.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_rays.glsl"
#include "cubemap/cube.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/finite.glsl"
#include "lib/hit_vertex.glsl"
#include "lib/microfacet.glsl"
#include "lib/mirrored.glsl"
#include "lib/narrow.glsl"
#include "lib/ray_offset.glsl"

// What the middle of a texel of an object's map shows (Larsen & Christensen 2004, section 6): the nearest surface along one ray from the object's middle. The surface is
// listed, one point a texel, so that later passes find its light; unlit surfaces are seen as they are, in W/(m²·sr), emissive ones and the sky in metal alone.
//
// The object does not see itself, but for fronts with a diffuse lobe: a room mirrors its own walls. What else has no diffuse lobe is not the end: metal is followed as a
// smooth mirror, glass is looked through straight on.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Points { MirroredPoint points[]; };
layout(set = 0, binding = 1) writeonly buffer Seen { vec4 seen[]; };  // unlit light, 1 over the depth along the face's axis (0: nothing)

layout(push_constant, scalar) uniform Push {
    vec3 middle;
    uint first_triangle;  // of the object
    vec3 sky;             // W/(m²·sr)
    uint end_triangle;
} push;

// Surfaces that a ray meets at most, and mirrors among them that it follows.
const uint MOST_MET = 32u;
const uint MOST_MIRRORS = 3u;

// How far a hit's texture coordinates move as the direction turns by `turn`.
vec4 texcoord_step(Triangle triangle, float distance, vec3 direction, vec3 turn) {
    vec3 normal = cross(triangle.edge1, triangle.edge2);
    vec3 turned = direction + turn;
    vec3 moved = distance * (dot(direction, normal) / dot(turned, normal) * turned - direction);
    float inverse = 1.0 / max(dot(normal, normal), 1e-37);
    float u = dot(cross(moved, triangle.edge2), normal) * inverse;
    float v = dot(cross(triangle.edge1, moved), normal) * inverse;
    vec4 step = interpolated(corner_texcoords, triangle, vec3(-u - v, u, v));
    return is_finite(step.xyz) && is_finite(step.w) ? step : vec4(0.0);
}

Footprint footprint_of(Triangle triangle, float distance, vec3 direction) {
    Footprint footprint = Footprint(vec4(0.0), vec4(0.0));
    if (TEXTURES != 0u) {
        Frame frame = frame_around(direction);
        float turn = 2.0 / float(CUBE_SIDE);
        footprint.dx = texcoord_step(triangle, distance, direction, turn * frame.tangent);
        footprint.dy = texcoord_step(triangle, distance, direction, turn * frame.bitangent);
    }
    return footprint;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= 6u * CUBE_SIDE * CUBE_SIDE) {
        return;
    }
    vec3 by_axis = direction_of_texel(index, CUBE_SIDE);
    vec3 direction = normalize(by_axis);
    vec3 origin = push.middle;
    float way = 0.0;  // to `origin`, m
    vec3 weight = vec3(1.0);
    Surface nothing = Surface(push.middle, -direction, -direction, vec3(0.0), vec3(0.0), 0.0, 1.0);
    MirroredPoint point = pack_mirrored(Mirrored(nothing, -direction, vec3(0.0), 0u, 0.0, false));
    vec4 shown = vec4(0.0);
    uint mirrors = 0u;
    [[dont_unroll]] for (uint met_count = 0u; met_count < MOST_MET; ++met_count) {
        Hit hit = closest_hit(origin, direction, 3e38);
        if (hit.triangle == NO_TRIANGLE) {
            shown.rgb = mirrors > 0u ? weight * push.sky : vec3(0.0);
            break;
        }
        Triangle triangle = load_triangle(triangles, hit.triangle);
        HitVertex met = vertex_of_hit(triangle, hit, origin, direction, footprint_of(triangle, way + hit.distance, direction));
        way += hit.distance;
        bool own = hit.triangle >= push.first_triangle && hit.triangle < push.end_triangle;
        bool back = dot(front_normal(triangle), direction) > 0.0;
        bool diffuse = met.unlit || max3(met.matter.diffuse_albedo) > 0.0;
        if (own ? back || !diffuse : !diffuse && max3(met.matter.transmission) > 0.0) {
            weight *= own ? vec3(1.0) : met.transmittance * met.matter.transmission;
            origin = offset_ray_origin(met.position, -met.face);
            continue;
        }
        weight *= own ? vec3(1.0) : met.transmittance;
        if (mirrors == 0u) {
            shown.w = length(by_axis) / max(way, 1e-20);
        }
        if (!diffuse && mirrors < MOST_MIRRORS) {
            float cosine = -dot(direction, met.normal);
            weight *= schlick_fresnel(met.matter.f0, met.matter.f90, cosine);
            vec3 mirrored = reflect(direction, met.normal);
            direction = dot(mirrored, met.face) > 0.0 ? mirrored : reflect(direction, met.face);
            origin = offset_ray_origin(met.position, met.face);
            ++mirrors;
            continue;
        }
        // Lamps that are mirrored once are for the slot `direct`.
        shown.rgb = met.unlit || mirrors > 0u ? weight * met.emitted : vec3(0.0);
        if (!met.unlit) {
            // Reflections of lamps in narrow lobes belong to where they are seen from, which is not the map's middle.
            bool narrow = is_narrow(met.matter.alpha);
            vec3 albedo = met.matter.diffuse_albedo;
            albedo = narrow ? indirect_diffuse_albedo(albedo, met.matter.f0, met.matter.f90) : albedo;
            Surface surface = Surface(
                met.position, met.normal, met.face, albedo, narrow ? vec3(0.0) : met.matter.f0, narrow ? 0.0 : met.matter.f90, met.roughness);
            point = pack_mirrored(Mirrored(surface, -direction, weight, 0u, hit.distance, false));
        }
        break;
    }
    points[index] = point;
    seen[index] = shown;
}
