#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "lib/traced_scene.glsl"
#include "particles/again.glsl"
#include "particles/albedo.glsl"
#include "particles/facets.glsl"
#include "particles/home.glsl"
#include "particles/home_words.glsl"
#include "particles/shading_normal.glsl"
#include "particles/tallies.glsl"
#include "particles/widths.glsl"

// Finds the particle that stands for one facet (home.glsl, at its middle), by which links find it too, and adds the facet to what that particle stands for. So the
// area of a particle is that of its catchment, not an even share:
//
//   ΔA_i = Σ_{f : home(f) = i} A_f,   ρ_i = mean of ρ(x_f) over these, weighted by area
//
// and likewise of what broad specular lobes reflect, where there are any. Areas are whole steps, rounded up or down at random, so that the smallest count as well.
// Where something moved, the facets that this may concern (touched_facets.comp) are taken off the particles that stood for them, and counted again.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer facets;  // records of triangles and of cells (facets.glsl)
layout(set = 0, binding = 1) buffer Tallies { uint tallies[]; };  // area, red, green, blue of each; broad lobes' red, green, blue, unused (tallies.glsl)
layout(set = 0, binding = 2) buffer Lost { uint lost[]; };
layout(set = 0, binding = 3) buffer Homes { uint homes[]; };      // of each facet (home_words.glsl)
layout(set = 0, binding = 4) uniform usamplerBuffer head;
layout(set = 0, binding = 5) uniform usamplerBuffer again;
layout(set = 0, binding = 6) uniform FacetSize { float facet_size; };
layout(set = 0, binding = 7) uniform samplerBuffer areas;  // of all sides of each triangle: the same bits wherever it moves

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint again;           // 1: those facets alone that are listed
} push;

void add_albedo(uint first, uvec3 albedo, uint area) {
    atomicAdd(tallies[first], albedo.r * area);
    atomicAdd(tallies[first + 1u], albedo.g * area);
    atomicAdd(tallies[first + 2u], albedo.b * area);
}

void count_facet(uint home, uvec3 albedo, uvec3 broad, uint area) {
    uint first = 4u * tally_texels() * home;
    atomicAdd(tallies[first], area);
    add_albedo(first + 1u, albedo, area);
    if (BROAD_LOBES != 0u) {
        add_albedo(first + 4u, broad, area);
    }
}

// How far from its edges a facet's corners are looked at, as a share of it, and how far above it, as a share of the spacing.
const float INSIDE = 0.02;
const float ABOVE_FACET = 0.01;

// Whether something stands on the facet: whether its corners do not see each other, across it.
bool is_parted(Triangle triangle, Span span, uint apex, vec3 face, float spacing) {
    vec3 front = front_normal(triangle);
    bool parted = false;
    [[dont_unroll]] for (uint diagonal = 0u; diagonal < 2u && !parted; ++diagonal) {
        vec2 low = vec2(INSIDE, diagonal == 0u ? INSIDE : 1.0 - INSIDE);
        vec3 from = offset_ray_origin(point_of_triangle(triangle, place_in(span, apex, low), front), face);
        vec3 to = offset_ray_origin(point_of_triangle(triangle, place_in(span, apex, 1.0 - low), front), face);
        vec3 lift = ABOVE_FACET * spacing * face;
        parted = is_occluded(from + lift, to - from, 1.0);
    }
    return parted;
}

void main() {
    uvec2 counts = texelFetch(facets, int(push.triangle_count)).xy;
    uint facet_count = counts.x;
    uint facet = push.again != 0u ? number_again(head, again, facet_count) : invocation_of_list();
    if (facet >= facet_count) {
        return;
    }
    uint cell = record_of(facets, push.triangle_count + 1u, counts.y, facet);
    uint index = record_of(facets, 0u, push.triangle_count, cell);
    uvec2 record = texelFetch(facets, int(index)).xy;
    uvec2 cell_record = texelFetch(facets, int(cell)).xy;
    Cuts cells = unpack_cuts(record.y);
    Cuts cuts = unpack_cuts(cell_record.y);
    bool back = cell - record.x >= cells.columns * cells.rows;
    Span span = part_of(part_of(WHOLE, cells, cell - record.x), cuts, facet - cell_record.x);
    vec2 middle = middle_of(span, cuts.apex);
    Triangle triangle = load_triangle(triangles, index);
    Material material = load_material(materials, triangle.material);
    vec3 front = front_normal(triangle);
    vec3 face = back ? -front : front;
    vec3 position = point_of_triangle(triangle, middle, front);
    vec3 normal = shading_normal(triangle, middle, face);

    float spacing = particle_spacing * spacing_of_width(cuts.width);
    vec3 start = offset_ray_origin(position, face);
    float looked = 2.0 * LIFT * spacing;
    Hit above = closest_hit(start, normal, looked);
    float free = above.triangle == NO_TRIANGLE ? looked : above.distance;
    uint home = home_of(position, normal, lift_of_point(start, normal, normal, free));
    uint before = push.again != 0u ? home_of_word(homes[facet]) : LOST_FACET;
    homes[facet] = home == NO_PARTICLE ? LOST_FACET : home | (is_parted(triangle, span, cuts.apex, face, spacing) ? PARTED_FACET : 0u);
    // Alpha leaves nothing there; links may end beside its middle.
    bool is_there = ALPHA_MASKS == 0u || material.alpha_cutoff < 0.0 || is_covered(triangle, material, middle);
    if (!is_there) {
        return;
    }
    uvec3 albedo = uvec3(diffuse_albedo_at(triangle, material, middle) * ALBEDO_STEPS + 0.5);
    uvec3 broad = uvec3(0u);
    if (BROAD_LOBES != 0u) {
        broad = uvec3(broad_albedo_at(triangle, material, middle) * ALBEDO_STEPS + 0.5);
    }
    float area = texelFetch(areas, int(index)).x / float(cells.sides) * share_of(span);
    float random = float(seed_of(facet, 2u) >> 8) / 16777216.0;
    uint steps = uint(area / area_step(facet_size) + random);
    if (before != LOST_FACET) {
        count_facet(before, albedo, broad, 0u - steps);
    }
    if (home == NO_PARTICLE) {
        atomicAdd(lost[0], 1u);
    } else {
        count_facet(home, albedo, broad, steps);
    }
}
