#version 460
#include "lib/prelude.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/hit_vertex.glsl"
#include "lib/photon_start.glsl"
#include "lib/sobol.glsl"
#include "final_gather/records.glsl"

// One photon (Jensen 1996): from a light along its scatterings, of any lobe, left at each surface with a diffuse one. Of N photons each carries
//
//   Φ = I(ω)/(N P p(ω))   point, spot      E⊥·πR²/(N P)   directional      π·L/(N P p(y)) a side   emissive triangle      L·4π·πR²/(N P)   sky     [W]
//
// with the light drawn by its share P of the power, the sky by a share of its own; parallel light and the sky's start on a disc across their direction, as
// large as the sphere of radius R around all that matters. A scattering multiplies Φ by f|cos|/p and by what the shading normal changes for light that comes
// from it (Veach 1997, 5.3.2); Russian roulette keeps it at what it was.

layout(local_size_x = 64) in;

// 1: surfaces lie beyond R, which may hide parallel light and the sky.
layout(constant_id = 0) const uint FAR_SURFACES = 0u;

layout(set = 0, binding = 0) writeonly buffer Photons { MapRecord photons[]; };
layout(set = 0, binding = 1) writeonly buffer Buckets { uint buckets[]; };
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };  // of the buckets
layout(set = 0, binding = 3) buffer Head { uint head[]; };      // photons, also those for which there was no room · rays

layout(push_constant, scalar) uniform Push {
    uint photon_count;
    uint emitter_count;
    float sky_share;     // of the photons
    uint bounces;        // scatterings between the light and the surface that a picture shows, at most
    vec3 sky;            // W/(m²·sr)
    float radius;        // R, m
    vec3 middle;         // of the scene
    uint capacity;
    uint bits;           // of the grid
    float inverse_cell;  // 1/m
} push;

const uint STREAMS = 0xF16A7u;

Start start_of(uint photon) {
    vec4 random = sobol_sample(sobol, photon, STREAMS);
    vec4 more = sobol_sample(sobol, photon, STREAMS + 1u);
    float others = 1.0 - push.sky_share;
    float paths = float(push.photon_count);
    Reach reach = Reach(push.middle, push.radius, FAR_SURFACES != 0u);
    if (random.x >= others) {
        return start_at_sky(reach, push.sky, vec4(random.yz, more.xy), push.sky_share * paths);
    }
    Emitter emitter = pick_emitter(emitters, push.emitter_count, min(random.x / others, 0.99999994));
    if (emitter.is_triangle) {
        return start_at_triangle(emitter.number, random.yz, more, others * paths);
    }
    return start_at_light(reach, emitter.number, more, emitter.probability * others * paths);
}

void store(HitVertex vertex, vec3 flux, uint number) {
    uint place = atomicAdd(head[0], 1u);
    if (place < push.capacity) {
        uint bucket = bucket_of(cell_of(vertex.position, push.inverse_cell), push.bits);
        photons[place] = MapRecord(
            uvec4(floatBitsToUint(vertex.position), pack_direction(vertex.face)), uvec4(floatBitsToUint(flux), number));
        buckets[place] = bucket;
        atomicAdd(counts[bucket], 1u);
    }
}

void main() {
    uint photon = gl_GlobalInvocationID.x;
    if (photon >= push.photon_count) {
        return;
    }
    Start start = start_of(photon);
    vec3 origin = start.origin;
    vec3 direction = start.direction;
    vec3 flux = start.flux;
    uint rays = 0u;
    // What is scattered here is scattered once more than what came.
    uint most = min(push.bounces, MOST_EVENTS);
    [[dont_unroll]] for (uint event = 0u; event < most && max3(flux) > 0.0 && is_finite(flux); ++event) {
        Hit hit = closest_hit(origin, direction, 3e38);
        ++rays;
        if (hit.triangle == NO_TRIANGLE) {
            break;
        }
        HitVertex vertex = vertex_of_hit(load_triangle(triangles, hit.triangle), hit, origin, direction, Footprint(vec4(0.0), vec4(0.0)));
        if (vertex.unlit) {
            break;
        }
        flux *= vertex.transmittance * (event == 0u ? range_window(hit.distance, start.range) : 1.0);
        Frame frame = frame_around(vertex.normal);
        vec3 viewer = to_local(frame, -direction);
        float shading = max(viewer.z, 0.0) / max(abs(dot(vertex.face, direction)), 1e-6);
        vec3 received = flux * shading;
        if (max3(vertex.matter.diffuse_albedo) > 0.0 && max3(received) > 0.0) {
            store(vertex, received, number_of_photon(photon, event));
        }
        vec4 random = sobol_sample(sobol, photon, STREAMS + 2u + event);
        viewer = normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
        LobeSample drawn = sample_lobes(vertex.matter, viewer, random.x, random.yz);
        direction = to_world(frame, drawn.direction);
        float side = dot(vertex.face, direction);
        if (drawn.density <= 0.0 || side * drawn.direction.z <= 0.0) {
            break;
        }
        vec3 sent = received * drawn.weight * (abs(side) / max(abs(drawn.direction.z), 1e-6));
        float survival = min(max3(sent) / max(max3(flux), 1e-37), event < 8u ? 1.0 : 0.95);
        if (random.w >= survival) {
            break;
        }
        flux = sent / survival;
        origin = offset_ray_origin(vertex.position, side > 0.0 ? vertex.face : -vertex.face);
    }
    atomicAdd(head[1], rays);
}
