#version 460
#include "lib/prelude.glsl"
#include "groups/photon_lists.glsl"
#include "photon_lists/hit.glsl"

// What lies at the distance that a photon's lines found: of the nodes in whose columns the hit is, the one that the ray meets nearest to it.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer rays;
layout(set = 0, binding = 1) buffer Hits { uint hits[]; };
layout(set = 0, binding = 2) readonly buffer Counts { uint counts[]; };

layout(push_constant, scalar) uniform Push {
    uint resolution;
    uint view_count;
    uint stage;
    uint capacity;
} push;

void search(uint view_index, PhotonRay ray, float found, inout NodeHit closest) {
    ListView view = load_list_view(list_views, view_index);
    ViewRay along = view_ray(view, ray);
    vec3 at = along.start + found * along.step;
    vec2 texel = at.xy / at.z;
    if (!is_finite(texel)) {
        return;
    }
    ivec2 first = ivec2(floor(clamp(texel, -2.0, float(push.resolution) + 2.0) - 0.5));
    // Columns reach a texel beyond their centres.
    for (uint place = 0u; place < 4u; ++place) {
        ivec2 cell = first + ivec2(place & 1u, place >> 1);
        uint index = NO_NODE;
        if (all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, ivec2(push.resolution)))) {
            uint row = view_index * push.resolution + uint(cell.y);
            index = texelFetch(list_pixels, int(row * push.resolution + uint(cell.x))).x;
        }
        vec2 center = vec2(cell) + 0.5;
        Column column = column_of(view, center);
        FOR_NODES_OF_LIST(index) {
            uvec4 node = texelFetch(list_nodes, int(index));
            float distance = distance_to_node(node, view, column, center, LINE_COLUMN, along, ray);
            take_nearer(closest, abs(distance - found), node);
            index = node.z;
        }
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    uint count = min(counts[STAGE_WORDS * push.stage + COUNT_WORD], push.capacity);
    if (index < count && hits[4u * index] != HIT_NONE) {
        PhotonRay ray = load_photon_ray(rays, index);
        float found = uintBitsToFloat(hits[4u * index]);
        NodeHit closest = NodeHit(NO_HIT_DISTANCE, 0u, 0u);
        for (uint view = 0u; view < push.view_count; ++view) {
            search(view, ray, found, closest);
        }
        if (closest.distance == NO_HIT_DISTANCE) {
            hits[4u * index] = HIT_NONE;
        }
        hits[4u * index + 1u] = closest.normal;
        hits[4u * index + 2u] = closest.material;
    }
}
