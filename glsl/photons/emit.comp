#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "groups/light_views.glsl"
#include "lib/lights.glsl"
#include "light_views/flux.glsl"
#include "photons/arrivals.glsl"
#include "photons/beam.glsl"
#include "photons/choice.glsl"
#include "photons/medium.glsl"
#include "photons/random.glsl"
#include "photons/shares.glsl"
#include "photons/surface_texel.glsl"

// One invocation makes one photon where light first meets a specular surface. It stands for the flux W that its block of the mask's
// pyramid holds, and sits on one of the block's texels, drawn with probability w/W by the flux w of that: down the pyramid, one of four
// blocks at a time. It carries
//
//   Φ = Φ_texel · W/w / m        [W], Φ_texel = I(ω)·Δω (light_views/flux.glsl), m photons a block
//
// so that the photons' flux adds up to what all specular surfaces receive, silhouettes included: the paper's rule, that all four texels
// below must be specular (Quyen 2014, section 3.3.1.1), loses them. Of m photons to a block each draws from its m-th of the flux, and if the
// block is a texel, has its place in it. Where photons are no multiple of the blocks, some have m + 1 (photons/shares.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D mask;
layout(set = 0, binding = 1) uniform usamplerBuffer levels;
layout(set = 0, binding = 2) uniform usamplerBuffer pyramid;
layout(set = 0, binding = 3) uniform usamplerBuffer choice;
layout(set = 0, binding = 4) uniform usamplerBuffer blocks;
layout(set = 0, binding = 5) uniform usamplerBuffer tile_views;  // the view of each square of 16x16 texels
layout(set = 0, binding = 6) uniform usampler2D specular_surface;
layout(set = 0, binding = 7) uniform usampler2D specular_layer;
layout(set = 0, binding = 8) writeonly buffer ArrivalBlock { uvec4 arrivals[]; };
layout(set = 0, binding = 9) writeonly buffer SurfaceBlock { uvec4 surfaces[]; };

layout(set = 0, binding = 10) writeonly buffer BeamBlock { vec4 arrival_beams[]; };

layout(push_constant, scalar) uniform Push {
    uint tiles_per_row;
    float radius;  // of the scene, m
    uint first;    // of the turn: photons of this number, and every `stride`-th from there on
    uint stride;
} push;

#include "photons/pyramid.glsl"

float flux_of_block(uint number, ivec2 block) {
    Level level = load_level(number);
    if (!holds(level, block)) {
        return 0.0;
    }
    return number == 0u ? sound_flux(texelFetch(mask, block, 0).x) : uintBitsToFloat(texelFetch(pyramid, int(place_of_block(level, block))).x);
}

// From the middle of a texel, in texels: point `turn` of `count` of Hammersley's set.
vec2 place_in_texel(uint turn, uint count) {
    float rows = exp2(float(findMSB(2u * count - 1u)));
    return vec2((float(turn) + 0.5) / float(count), float(bitfieldReverse(turn) >> 8) * (1.0 / 16777216.0) + 0.5 / rows) - 0.5;
}

// Where a photon sits, and W/w.
struct Place {
    ivec2 texel;
    float weight;
};

Place draw_texel(uint level, ivec2 block, float random) {
    float whole = flux_of_block(level, block);
    float part = whole;
    [[dont_unroll]] while (level > 0u) {
        --level;
        block *= 2;
        vec4 quad = vec4(
            flux_of_block(level, block), flux_of_block(level, block + ivec2(1, 0)),
            flux_of_block(level, block + ivec2(0, 1)), flux_of_block(level, block + ivec2(1, 1)));
        float rest = random * ((quad.x + quad.y) + (quad.z + quad.w));
        // The last block that is not empty takes what rounding leaves.
        int chosen = 0;
        part = 0.0;
        [[dont_unroll]] for (int child = 0; child < 4; ++child) {
            float flux = quad[child];
            bool goes_on = rest >= part && part > 0.0;
            if (flux > 0.0 && (part <= 0.0 || goes_on)) {
                rest -= part;
                part = flux;
                chosen = child;
            }
        }
        random = clamp(rest / part, 0.0, 0.99999994);
        block += ivec2(chosen & 1, chosen >> 1);
    }
    return Place(block, whole / part);
}

#include "photons/cells.glsl"

// Where the light's ray a step of tangents further meets the plane of the surface.
vec3 position_on_plane(LightView view, CellPoint point, vec2 step, vec3 normal) {
    vec2 tangent = point.tangent + step;
    float depth = depth_of_plane(view, point.tangent, tangent, point.depth, normal);
    // Seen edge-on, the plane runs off to infinity.
    depth = is_orthographic(view) ? depth : clamp(depth, 0.5 * point.depth, 2.0 * point.depth);
    return position_of_texel(view, tangent, depth);
}

// The shading normal of a neighbour; that of the texel itself where the neighbour is of another surface, or where the surface is of flat
// facets: the neighbour's shading normal is then its triangle's.
vec3 normal_beside(LightView view, ivec2 texel, uint material, vec3 own) {
    if (!is_in_view(view, texel) || texelFetch(specular_layer, texel, 0).y != material || texelFetch(mask, texel, 0).x <= 0.0) {
        return own;
    }
    uvec2 normals = texelFetch(specular_surface, texel, 0).xy;
    vec3 normal = unpack_direction(normals.x);
    return normals.x != normals.y && dot(normal, own) > 0.7 ? normal : own;
}

// The change of the shading normal from one texel to the next along `step`, from those on both sides that are of the same surface.
vec3 normal_change(LightView view, ivec2 texel, ivec2 step, uint material, vec3 own) {
    vec3 after = normal_beside(view, texel + step, material, own);
    vec3 before = normal_beside(view, texel - step, material, own);
    float sides = float(after != own) + float(before != own);
    return (after - before) / max(sides, 1.0);
}

// Whether the surface ends beside the texel: its photons then crowd on one side of it (photons/cells.glsl).
bool is_outline(LightView view, ivec2 texel, ivec2 step) {
    bool whole = is_in_view(view, texel + step) && is_in_view(view, texel - step);
    return !whole || min(texelFetch(mask, texel + step, 0).x, texelFetch(mask, texel - step, 0).x) <= 0.0;
}

void main() {
    uint arrival = gl_GlobalInvocationID.x;
    uint photon = push.first + push.stride * arrival;
    uint photons = texelFetch(choice, int(CHOICE_PHOTONS)).x;
    if (photon >= photons) {
        return;
    }
    uint level = texelFetch(choice, int(CHOICE_LEVEL)).x;
    uint block_count = texelFetch(choice, int(CHOICE_BLOCKS)).x;
    uint rank = block_of_photon(photon, photons, block_count);
    uint first = first_photon_of(rank, photons, block_count);
    uint of_block = first_photon_of(rank + 1u, photons, block_count) - first;
    uint packed_block = texelFetch(blocks, int(rank)).x;
    uvec2 block = uvec2(packed_block & 0xFFFFu, packed_block >> 16);
    uint turn = photon - first;
    // The one that some blocks have more has a sequence of its own, so that all others stay along the curve without gaps.
    uint of_all = texelFetch(choice, int(CHOICE_OF_BLOCK)).x;
    uint number = turn < of_all ? morton_code(block) * of_all + turn : 0x80000000u | morton_code(block);
    vec4 random = photon_random(number, 0u);
    Place place = draw_texel(level, ivec2(block), (float(turn) + random.x) / float(of_block));

    ivec2 texel = place.texel;
    LightView view = load_view(views, texelFetch(tile_views, (texel.y >> 4) * int(push.tiles_per_row) + (texel.x >> 4)).x);
    float depth = texelFetch(light_depth, texel, 0).x;
    uvec4 surface = texelFetch(specular_surface, texel, 0);
    uvec2 layer = texelFetch(specular_layer, texel, 0).xy;
    vec2 middle = tangent_of_texel(view, vec2(texel) + 0.5);
    CellPoint point = CellPoint(middle, depth);
    if (level == 0u && of_block > 1u) {
        point = point_of_cell(view, texel, place_in_texel(turn, of_block), depth, unpack_direction(surface.y));
    }
    vec3 position = position_of_texel(view, point.tangent, point.depth);

    // A directional light counts as at the scene's radius from what it lights.
    vec3 ray = ray_of_tangent(view, point.tangent);
    float texel_width = view.tangent_step * (is_orthographic(view) ? 1.0 : linear_depth(view, depth));
    float lit_way = is_orthographic(view) ? push.radius : distance(position, view.origin_rs);
    vec3 flux = incident_flux(load_light(lights, view.light), view, vec2(texel) + 0.5, depth);
    Material material = load_material(drawn_materials, layer.y & ~SURFACE_FRONT);
    bool front = (layer.y & SURFACE_FRONT) != 0u;
    flux *= transmittance_behind(material, front, length(ray_of_tangent(view, middle)) * depth_from_light(view, depth));
    flux *= place.weight / float(of_block);

    bool is_closed = medium_of(material).is_closed;
    bool refracts = is_closed && material.ior > 0.0 && surface.w != 0u;
    float relative_ior = !refracts ? 1.0 : front ? material.ior : 1.0 / material.ior;
    uint bits = is_closed && !front ? PHOTON_INSIDE : 0u;
    arrivals[3u * arrival] = uvec4(floatBitsToUint(position), floatBitsToUint(lit_way));
    arrivals[3u * arrival + 1u] = uvec4(floatBitsToUint(normalize(ray)), bits);
    arrivals[3u * arrival + 2u] = uvec4(floatBitsToUint(flux), number);
    // Views round the corners of what they draw to 1/256 of a texel.
    float gap = gap_at(position, 0.0) + texel_width / 64.0;
    // One photon to the next.
    float spacing = exp2(float(level)) * inversesqrt(float(of_block));
    vec3 face = unpack_direction(surface.y);
    vec3 own = unpack_direction(surface.x);
    vec3 origin_change[2];
    vec3 direction_change[2];
    vec3 normals[2];
    vec3 bent = own;
    [[dont_unroll]] for (int axis = 0; axis < 2; ++axis) {
        vec2 step = vec2(axis == 0, axis == 1) * view.tangent_step;
        vec3 origins = position_on_plane(view, point, step, face) - position_on_plane(view, point, -step, face);
        vec3 directions = normalize(ray_of_tangent(view, point.tangent + step)) - normalize(ray_of_tangent(view, point.tangent - step));
        ivec2 beside = ivec2(axis == 0, axis == 1);
        float apart = is_outline(view, texel, beside) ? max(spacing, 1.0) : spacing;
        origin_change[axis] = origins * (0.5 * apart);
        direction_change[axis] = directions * (0.5 * apart);
        vec3 change = normal_change(view, texel, beside, layer.y, own);
        normals[axis] = change * apart;
        // Within the texel the normal turns as it does from one to the next.
        bent += change * (dot(point.tangent - middle, step) / dot(step, step));
    }
    vec4 beam[3] = pack_beam(Beam(origin_change[0], origin_change[1], direction_change[0], direction_change[1]));
    uint texel_of_beam = ARRIVAL_BEAM_TEXELS * arrival;
    arrival_beams[texel_of_beam] = beam[0];
    arrival_beams[texel_of_beam + 1u] = beam[1];
    arrival_beams[texel_of_beam + 2u] = beam[2];
    arrival_beams[texel_of_beam + 3u] = vec4(normals[0], normals[1].x);
    arrival_beams[texel_of_beam + 4u] = vec4(normals[1].yz, 0.0, 0.0);
    surfaces[2u * arrival] = surface;
    surfaces[2u * arrival + 1u] = uvec4(layer.x, floatBitsToUint(relative_ior), floatBitsToUint(gap), pack_direction(normalize(bent)));
}
