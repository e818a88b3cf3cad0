#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/hit_vertex.glsl"
#include "lib/lights.glsl"
#include "lib/photon_start.glsl"
#include "lib/sobol.glsl"
#include "lightmaps/charts.glsl"
#include "lightmaps/photons.glsl"
#include "lightmaps/rounds.glsl"

// One photon (Larsen & Christensen 2004, section 2), from its light along its scatterings, of any lobe. Its directions are fixed: the square of directions of a light is
// cut into as many cells of equal area as it has groups, in which photons are Owen-scrambled Sobol' points. So a group's photons go the same way.
//
// PROBES: one photon of each group goes its way again; if it meets another surface or another point of it than it did, its group is stale. Else all photons of stale
// groups leave a new path, and note which surfaces had some of the old one or have some of the new one.
//
// A group that is sent again while nothing changed goes on along its points and its numbers: another round.
//
// CAUSTICS: what rays from texels do not find is left alone, the light of lamps without area that comes by specular lobes only, L S⁺ D.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint PROBES = 0u;
// 1: surfaces lie beyond the reach, which may hide parallel light and the sky.
layout(constant_id = 1) const uint FAR_SURFACES = 0u;

// 1: only what specular lobes alone scattered lands, and goes on.
layout(constant_id = 2) const uint CAUSTICS = 0u;
// 1: there are several rounds, and what is known of all of them is noted.
layout(constant_id = 3) const uint ROUNDS = 0u;

layout(set = 0, binding = 0) buffer Records { uvec4 records[]; };
layout(set = 0, binding = 1) buffer Stale { uint stale[]; };      // by group
layout(set = 0, binding = 2) buffer Touched { uint touched[]; };  // 1, by surface and side; behind all: photons sent, rays
layout(set = 0, binding = 3) buffer Past { uint past[]; };        // rounds.glsl

layout(push_constant, scalar) uniform Push {
    uint group_count;
    uint groups_a_light;
    uint light_count;     // punctual
    uint emitter_count;   // emissive triangles
    float density_scale;
    uint bounces;         // surfaces at most
    uint probe;           // the photon of each group that goes again
    uint surface_count;   // sides of surfaces
    vec3 sky;             // W/(m²·sr)
    float radius;         // of the reach, m
    vec3 middle;
    float slack;          // m: as far a point may be off another one and be the same
    uint round;           // that is sent
} push;

const uint STREAMS = 0x9407075u;

// The first cell of a row of cells of a light's square of directions.
uint first_of_row(uint row, uint rows) {
    return row * push.groups_a_light / rows;
}

vec2 in_cell(uint cell, vec2 random) {
    uint rows = max(uint(sqrt(float(push.groups_a_light)) + 0.5), 1u);
    uint row = min(cell * rows / push.groups_a_light, rows - 1u);
    row += row + 1u < rows && first_of_row(row + 1u, rows) <= cell ? 1u : 0u;
    uint first = first_of_row(row, rows);
    uint columns = first_of_row(row + 1u, rows) - first;
    return vec2((float(first) + float(columns) * random.x) / float(push.groups_a_light), (float(cell - first) + random.y) / float(columns));
}

// A sample of the round, of so many in each.
uint in_round(uint number, uint count, uint round) {
    return round * count + number;
}

Start start_of(uint photon, uint round) {
    uint number = photon / PHOTONS_A_GROUP;
    uint own = photon % PHOTONS_A_GROUP;
    uint light = number / push.groups_a_light;
    uint point = in_round(own, PHOTONS_A_GROUP, round);
    vec4 random = sobol_sample(sobol, point, seed_of(STREAMS, number));
    vec4 more = sobol_sample(sobol, point, seed_of(STREAMS + 1u, number));
    vec2 place = in_cell(number % push.groups_a_light, random.xy);
    float photons = float(push.groups_a_light * PHOTONS_A_GROUP);
    Reach reach = Reach(push.middle, push.radius, FAR_SURFACES != 0u);
    if (light < push.light_count) {
        return start_at_light(reach, light, vec4(place, random.zw), photons);
    }
    if (light == push.light_count && push.emitter_count > 0u) {
        Emitter emitter = pick_emitter(emissive_triangles, push.emitter_count, min(place.x, 0.99999994));
        return start_at_triangle(emitter.number, vec2(place.y, random.z), more, push.density_scale * photons);
    }
    return start_at_sky(reach, push.sky, vec4(place, random.zw), photons);
}

bool differs(uint record, vec3 position, uint texel) {
    vec3 way = uintBitsToFloat(records[record].xyz) - position;
    return records[record + 1u].w != 0u || records[record].w != texel || dot(way, way) > push.slack * push.slack;
}

// The surface of a texel has other photons than it had, or has photons of these lights.
void touch(uint texel, uint lights) {
    if (texel != NO_TEXEL) {
        uint side = texelFetch(lightmap_texels, 2 * int(texel) + 1).w;
        atomicMax(touched[side], 1u);
        if (ROUNDS != 0u && (past[side] & lights) != lights) {
            atomicOr(past[side], lights);
        }
    }
}

// A light's paths have a point there.
void note_point(uint light, vec3 position) {
    if (PROBES == 0u && ROUNDS != 0u) {
        uint first = box_of_light(push.surface_count, light);
        [[dont_unroll]] for (uint word = 0u; word < 6u; ++word) {
            float value = word < 3u ? position[word] : -position[word - 3u];
            if (past[first + word] < ordered(value)) {
                atomicMax(past[first + word], ordered(value));
            }
        }
    }
}

// The texel that is nearest to where a ray met a side of a triangle.
uint texel_at(Hit hit, bool back) {
    Chart chart = load_chart(lightmap_charts, hit.triangle);
    uint first = first_of_side(chart, back);
    ivec2 near = ivec2(clamp(point_on_map(chart, hit.barycentric) + 0.5, vec2(0.0), vec2(chart.size - 1)));
    return first == NO_TEXEL ? NO_TEXEL : first + uint(near.y * chart.size.x + near.x);
}

// Notes that a path goes on into the open.
void note_way_out(uint record, uint light, vec3 origin, vec3 direction) {
    if (PROBES == 0u) {
        note_point(light, origin + 1e18 * direction);
        records[record] = uvec4(floatBitsToUint(origin + push.radius * direction), NO_TEXEL);
        records[record + 1u].w = PATH_LEFT;
    }
}

// Returns whether the path is another one than it was.
bool go(uint photon) {
    uint group = photon / PHOTONS_A_GROUP;
    uint light = group / push.groups_a_light;
    uint own_round = round_of_group(push.surface_count, push.group_count / push.groups_a_light, group);
    uint round = push.round;
    if (ROUNDS != 0u && PROBES != 0u) {
        round = past[own_round];
    } else if (ROUNDS != 0u && photon % PHOTONS_A_GROUP == 0u) {
        past[own_round] = round;
    }
    Start start = start_of(photon, round);
    vec3 origin = start.origin;
    vec3 direction = start.direction;
    vec3 flux = start.flux;
    if (PROBES == 0u) {
        [[dont_unroll]] for (uint event = 0u; event < RECORDS_A_PHOTON; ++event) {
            uint record = record_of(photon, event);
            if (records[record + 1u].w == 0u && event > 0u) {
                touch(records[record].w, 0u);
            }
            records[record] = uvec4(floatBitsToUint(start.origin), NO_TEXEL);
            records[record + 1u] = uvec4(floatBitsToUint(start.flux), event > 0u ? PATH_ENDED : 0u);
        }
        note_point(light, start.origin);
    }
    uint rays = 0u;
    uint event = 1u;
    uint end = min(push.bounces, RECORDS_A_PHOTON - 1u);
    [[dont_unroll]] for (; event <= end && max3(flux) > 0.0 && is_finite(flux); ++event) {
        Hit hit = closest_hit(origin, direction, 3e38);
        ++rays;
        if (hit.triangle == NO_TRIANGLE) {
            note_way_out(record_of(photon, event), light, origin, direction);
            break;
        }
        HitVertex vertex = vertex_of_hit(load_triangle(triangles, hit.triangle), hit, origin, direction, Footprint(vec4(0.0), vec4(0.0)));
        if (vertex.unlit) {
            note_way_out(record_of(photon, event), light, origin, direction);
            break;
        }
        flux *= vertex.transmittance * (event == 1u ? range_window(hit.distance, start.range) : 1.0);
        Frame frame = frame_around(vertex.normal);
        vec3 viewer = to_local(frame, -direction);
        float shading = max(viewer.z, 0.0) / max(abs(dot(vertex.face, direction)), 1e-6);
        vec3 received = flux * shading;
        bool back = dot(front_normal(load_triangle(triangles, hit.triangle)), direction) > 0.0;
        bool lands = max3(vertex.matter.diffuse_albedo) > 0.0 && (CAUSTICS == 0u || event > 1u);
        uint texel = lands ? texel_at(hit, back) : NO_TEXEL;
        uint record = record_of(photon, event);
        if (PROBES != 0u) {
            if (differs(record, vertex.position, texel)) {
                return true;
            }
        } else {
            records[record] = uvec4(floatBitsToUint(vertex.position), texel);
            records[record + 1u] = uvec4(floatBitsToUint(received), 0u);
            touch(texel, bit_of_light(light));
            note_point(light, vertex.position);
        }
        uint point = in_round(photon, push.group_count * PHOTONS_A_GROUP, round);
        vec4 random = sobol_sample(sobol, point, STREAMS + 2u + event);
        viewer = normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
        LobeSample drawn = sample_lobes(vertex.matter, viewer, random.x, random.yz);
        direction = to_world(frame, drawn.direction);
        float side = dot(vertex.face, direction);
        bool ends = CAUSTICS != 0u && drawn.lobe != LOBE_SPECULAR;
        if (ends || drawn.density <= 0.0 || side * drawn.direction.z <= 0.0) {
            ++event;
            break;
        }
        vec3 sent = received * drawn.weight * (abs(side) / max(abs(drawn.direction.z), 1e-6));
        float survival = min(max3(sent) / max(max3(flux), 1e-37), 1.0);
        if (random.w >= survival) {
            ++event;
            break;
        }
        flux = sent / survival;
        origin = offset_ray_origin(vertex.position, side > 0.0 ? vertex.face : -vertex.face);
    }
    atomicAdd(touched[push.surface_count + 1u], rays);
    // A path that was longer is another one too.
    return PROBES != 0u && event <= end && records[record_of(photon, event) + 1u].w == 0u;
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (PROBES != 0u) {
        if (number < push.group_count && stale[number] == 0u && go(number * PHOTONS_A_GROUP + push.probe)) {
            stale[number] = 1u;
        }
    } else if (number < push.group_count * PHOTONS_A_GROUP && stale[number / PHOTONS_A_GROUP] != 0u) {
        go(number);
        atomicAdd(touched[push.surface_count], 1u);
    }
}
