#version 460
#include "lib/prelude.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_rays.glsl"
#include "groups/surface.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/hit_vertex.glsl"
#include "lib/mirrored.glsl"
#include "lib/pixel_rays.glsl"
#include "lib/pixels.glsl"
#include "lib/sobol.glsl"
#include "lib/surface_packing.glsl"
#include "lib/narrow.glsl"
#include "trace/samples.glsl"

// Follows reflections and refractions from the surface at one pixel (Whitted 1980; the preliminary pass of Chang et al. 4.3.1). Lists each surface that they
// come to, with what of its radiance the pixel sees,
//
//   L(x, v) = Σ w · L(y),     w = Π f|cos|/p over the specular events on the way
//
// and sums up what they meet that shines by itself. Reflection and refraction are both followed at the first events, later one of the two by its share; ways that
// carry little end by Russian roulette. The light at the listed points is the business of the passes that follow.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D glass;  // glass.comp
layout(set = 0, binding = 1) writeonly buffer Points { MirroredPoint points[]; };
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };  // word 0: points, word 1: rays
layout(set = 0, binding = 3, r32ui) writeonly uniform uimage2D heads;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D shining;

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    uint first_row;
    vec3 sky;              // W/(m²·sr)
    uint sample_count;     // rays of a wide lobe at the pixel
    uint depth;            // specular events at most
    uint capacity;         // points for which there is room
    uint lamps;            // 1: what shines is shown behind the first event too: `direct` does not
    uint point_lights;     // 1: there are lights that specular lobes alone can answer to
} push;

// Events at which both reflection and refraction are followed.
const uint SPLITS = 4u;
// Ways that carry less end by chance.
const float LITTLE = 0.01;
// A lobe below this roughness takes one ray: its reflections are sharp.
const float SMOOTH_ROUGHNESS = 0.05;
const uint MOST_WAITING = SPLITS + 1u;

// What emissive surfaces and the sky that a way runs into add.
const uint SHOWS_LAMPS = 1u;
const uint SHOWS_SKY = 2u;

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
vec3 shining_sum = vec3(0.0);
uint ray_count = 0u;
uint sample_count = 1u;  // of the pixel

// Of the lobe that reflects (0) or transmits (1).
uint rays_of(Vertex vertex, uint lobe, float cosine) {
    if (vertex.event > 0u || vertex.matter.alpha < SMOOTH_ROUGHNESS * SMOOTH_ROUGHNESS) {
        return 1u;
    }
    return samples_for(push.sample_count, max3(lobe == 0u ? fresnel(vertex.matter, cosine) : vertex.matter.transmission));
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
        uint shows = lobe == 1u ? SHOWS_LAMPS | SHOWS_SKY
                   : vertex.event > 0u ? (narrow ? SHOWS_LAMPS | SHOWS_SKY : SHOWS_SKY)
                   : narrow && push.lamps != 0u ? SHOWS_LAMPS | SHOWS_SKY : 0u;
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
    if (place < push.capacity) {
        Surface surface = Surface(
            vertex.position, vertex.normal, vertex.face, vertex.matter.diffuse_albedo, vertex.matter.f0, vertex.matter.f90, roughness);
        points[place] = pack_mirrored(Mirrored(surface, vertex.to_viewer, vertex.weight, head, ray_length));
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
        shining_sum += (way.shows & SHOWS_SKY) != 0u ? way.weight * push.sky : vec3(0.0);
        return false;
    }
    HitVertex met = vertex_of_hit(hit, way.origin, way.direction);
    way.weight *= met.transmittance;
    if (met.unlit || (way.shows & SHOWS_LAMPS) != 0u) {
        shining_sum += way.weight * met.emitted;
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
    bool wide = max(max3(met.matter.f0), met.matter.f90) > 0.0 && (push.point_lights != 0u ? vertex.matter.alpha > MINIMUM_ALPHA : !is_narrow(vertex.matter.alpha));
    list(vertex, met.roughness, hit.distance, !met.unlit && (wide || max3(met.matter.diffuse_albedo) > 0.0));
    return !met.unlit && way.event < push.depth;
}

// The surface at a pixel. Returns whether it has a specular lobe.
bool vertex_of_pixel(ivec2 pixel, ivec2 size, out Vertex vertex) {
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec4 lobe = texelFetch(specular, pixel, 0);
    vec4 behind = TRANSMISSIVE != 0u ? texelFetch(glass, pixel, 0) : vec4(0.0, 0.0, 0.0, 1.0);
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    Surface point = unpack_surface(position_rs + push.shift, texelFetch(surface, pixel, 0), lobe);
    vertex.position = point.position_rs;
    vertex.origin = pixel_ray_origin(position_rs, push.shift, point.geometric_normal);
    vertex.face = point.geometric_normal;
    vertex.normal = point.normal;
    vertex.to_viewer = direction_to_eye(camera, position_rs);
    vertex.matter = Matter(
        point.diffuse_albedo, point.f0, point.f90, max(point.roughness * point.roughness, MINIMUM_ALPHA), behind.rgb, behind.a);
    vertex.weight = vec3(1.0);
    vertex.event = 0u;
    vertex.seed = seed_of_pixel(pixel);
    return pixel_depth > 0.0 && max(max3(lobe.rgb), max(lobe.a, max3(behind.rgb))) > 0.0;
}

void main() {
    ivec2 pixel = pixel_of_invocation() + ivec2(0, push.first_row);
    ivec2 size = imageSize(shining);
    if (!is_inside(pixel, size)) {
        return;
    }
    Vertex first;
    if (vertex_of_pixel(pixel, size, first)) {
        uint number = 0u;
        Vertex vertex = first;
        bool goes_on = true;
        [[dont_unroll]] while (number < sample_count) {
            if (goes_on) {
                send_on(vertex, number);
            }
            if (waiting_count > 0u) {
                goes_on = follow(vertex);
            } else {
                ++number;
                vertex = first;
                goes_on = true;
            }
        }
        if (ray_count > 0u) {
            atomicAdd(counts[1], ray_count);
        }
    }
    imageStore(heads, pixel, uvec4(head));
    imageStore(shining, pixel, vec4(is_finite(shining_sum) ? shining_sum : vec3(0.0), 1.0));
}
