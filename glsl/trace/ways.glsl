// Ways of light that end at a pixel, followed backwards from surface to surface: reflections and refractions at the first events, later one of the two by its
// share; ways that carry little end by Russian roulette. What they come to is listed (lib/mirrored.glsl); what shines on the way goes to a slot.
//
// The including kernel has `points`, `counts` (word 0: points), the push constant `walking`, and the three functions that are declared here alone.
#ifndef TRACE_WAYS
#define TRACE_WAYS

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/hit_vertex.glsl"
#include "lib/mirrored.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "lib/narrow.glsl"
#include "mirrored/samples.glsl"
#include "trace/walking.glsl"

// Events at which both reflection and refraction are followed.
const uint SPLITS = 4u;
// Ways that carry less end by chance.
const float LITTLE = 0.01;
const uint MOST_WAITING = SPLITS + 1u;

// What emissive surfaces and the sky that a way runs into add, and to which slot.
const uint SHOWS_LAMPS = 1u;
const uint SHOWS_SKY = 2u;
const uint IN_SPECULAR = 0u;
const uint IN_DIRECT = 4u;
const uint IN_EMISSION = 8u;
const uint SLOT_BITS = 12u;

// Adds what shines by itself to the sum of a slot: one of the three.
void add_shining(uint slot, vec3 radiance);

// What the first reflection shows: only the kernel knows which of it other passes find.
uint shows_of_first_reflection(bool narrow);

struct Vertex {
    vec3 position;
    vec3 origin;        // of rays that are reflected
    vec3 face;          // normals on the viewer's side
    vec3 normal;
    vec3 to_viewer;
    Matter matter;
    vec3 weight;
    uint event;         // specular events before it
    uint seed;
};

// How textures are filtered where a way from this event on meets a triangle.
Footprint footprint_of(uint event, Triangle triangle, Hit hit, vec3 origin, vec3 direction);

struct Way {
    vec3 origin;
    vec3 direction;
    vec3 weight;
    uint event;
    uint shows;
    uint seed;
};

Way waiting[MOST_WAITING];
uint waiting_count = 0u;
uint head = 0u;
uint ray_count = 0u;
uint sample_count = 1u;  // of the pixel

// Of the lobe that reflects (0) or transmits (1).
uint rays_of(Vertex vertex, uint lobe, float cosine) {
    if (vertex.event > 0u || vertex.matter.alpha < SMOOTH_ROUGHNESS * SMOOTH_ROUGHNESS) {
        return 1u;
    }
    return samples_for(push.walking.sample_count, max3(lobe == 0u ? fresnel(vertex.matter, cosine) : vertex.matter.transmission));
}

// Leaves the ways that start at a vertex. `number`: of the sample.
void send_on(Vertex vertex, uint number) {
    Frame frame = frame_around(vertex.normal);
    vec3 viewer = to_local(frame, vertex.to_viewer);
    viewer = normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
    vec3 shares = lobe_shares(vertex.matter, viewer.z);
    vec4 random = sobol_sample(sobol, number, vertex.seed);
    float reflected = shares.y / max(shares.y + shares.z, 1e-20);
    uint chosen = random.w < reflected ? 0u : 1u;
    bool splits = TRANSMISSIVE == 0u || vertex.event < SPLITS;
    [[dont_unroll]] for (uint lobe = 0u; lobe < (TRANSMISSIVE != 0u ? 2u : 1u); ++lobe) {
        float share = lobe == 0u ? shares.y : shares.z;
        uint rays = rays_of(vertex, lobe, viewer.z);
        sample_count = vertex.event == 0u && share > 0.0 ? max(sample_count, rays) : sample_count;
        if (share <= 0.0 || (vertex.event == 0u && number >= rays) || (!splits && lobe != chosen)) {
            continue;
        }
        LobeSample drawn = sample_lobes(vertex.matter, viewer, shares.x + (lobe == 0u ? 0.5 * shares.y : shares.y + 0.5 * shares.z), random.xy);
        vec3 direction = to_world(frame, drawn.direction);
        float side = dot(vertex.face, direction);
        if (drawn.density <= 0.0 || side * drawn.direction.z <= 0.0) {
            continue;
        }
        vec3 weight = vertex.weight * drawn.weight * (share / float(rays));
        if (!splits) {
            weight /= lobe == 0u ? reflected : 1.0 - reflected;
        }
        float carried = max3(weight);
        if (TRANSMISSIVE != 0u && side < 0.0) {
            // Radiance changes by the square of the ratio of indices: what is lost on the way into a medium is gained on the way out.
            float index = vertex.matter.relative_ior;
            weight /= index * index;
            carried = max(carried, max3(weight));
        }
        if (vertex.event > 0u) {
            float survival = min(carried / LITTLE, 1.0);
            if (random.z >= survival) {
                continue;
            }
            weight /= survival;
        }
        bool narrow = is_narrow(vertex.matter.alpha);
        uint shows = narrow || lobe == 1u ? SHOWS_LAMPS | SHOWS_SKY : SHOWS_SKY;
        if (vertex.event == 0u && lobe == 0u) {
            shows = shows_of_first_reflection(narrow);
        }
        vec3 origin = side > 0.0 ? vertex.origin : offset_ray_origin(vertex.position, -vertex.face);
        waiting[waiting_count] = Way(origin, direction, weight, vertex.event + 1u, shows, seed_of(vertex.seed, lobe + 1u));
        ++waiting_count;
    }
}

// Lists a point, if something may light it.
void list(Vertex vertex, float roughness, float ray_length, bool lit) {
    if (!lit) {
        return;
    }
    uint place = atomicAdd(counts[0], 1u);
    if (place < push.walking.capacity) {
        Surface surface = Surface(
            vertex.position, vertex.normal, vertex.face, vertex.matter.diffuse_albedo, vertex.matter.f0, vertex.matter.f90, roughness);
        points[place] = pack_mirrored(Mirrored(surface, vertex.to_viewer, vertex.weight, head, ray_length, vertex.event == 0u));
        head = place + 1u;
    }
}

// Follows the last of the waiting ways to the next surface. Returns whether the way may go on from there.
bool follow(out Vertex vertex) {
    --waiting_count;
    Way way = waiting[waiting_count];
    Hit hit = closest_hit(way.origin, way.direction, 3e38);
    ++ray_count;
    if (hit.triangle == NO_TRIANGLE) {
        if ((way.shows & SHOWS_SKY) != 0u) {
            add_shining(way.shows & SLOT_BITS, way.weight * push.walking.sky);
        }
        return false;
    }
    Triangle triangle = load_triangle(triangles, hit.triangle);
    Footprint footprint = footprint_of(way.event, triangle, hit, way.origin, way.direction);
    HitVertex met = vertex_of_hit(triangle, hit, way.origin, way.direction, footprint);
    // What lies before the first surface is left out, as drawing does.
    if (way.event > 0u) {
        way.weight *= met.transmittance;
    }
    if (met.unlit || (way.shows & SHOWS_LAMPS) != 0u) {
        // Of lights unlit surfaces are none: mirrors show them beside what is lit.
        uint slot = met.unlit && (way.shows & SLOT_BITS) == IN_DIRECT ? IN_SPECULAR : way.shows & SLOT_BITS;
        add_shining(slot, way.weight * met.emitted);
    }
    vertex.matter = met.matter;
    vertex.face = met.face;
    vertex.position = met.position;
    vertex.origin = offset_ray_origin(vertex.position, vertex.face);
    vertex.normal = met.normal;
    vertex.to_viewer = -way.direction;
    vertex.weight = way.weight;
    vertex.event = way.event;
    vertex.seed = way.seed;
    bool answers = push.walking.point_lights != 0u ? way.event == 0u || vertex.matter.alpha > MINIMUM_ALPHA : !is_narrow(vertex.matter.alpha);
    bool wide = max(max3(met.matter.f0), met.matter.f90) > 0.0 && answers;
    list(vertex, met.roughness, hit.distance, !met.unlit && (wide || max3(met.matter.diffuse_albedo) > 0.0));
    return !met.unlit && way.event < push.walking.depth;
}

#endif
