#version 460
#include "lib/prelude.glsl"
#include "groups/photon_lists.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "photon_lists/hit.glsl"
#include "photon_lists/slices.glsl"

// The nearest surface that one photon meets, by a march over the texels that its ray crosses in each view (a DDA in homogeneous coordinates, so that
// perspective needs no other), past blocks in whose slices of depth the ray meets no surface (photon_lists/slices.glsl). Distances in m.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer rays;
layout(set = 0, binding = 1) uniform usamplerBuffer blocks;
layout(set = 0, binding = 2) readonly buffer Counts { uint counts[]; };
layout(set = 0, binding = 3) writeonly buffer Hits { uint hits[]; };
layout(set = 0, binding = 4) buffer Work { uint work[]; };  // steps, misses, rays that were cut off

layout(push_constant, scalar) uniform Push {
    uint resolution;
    uint view_count;
    uint stage;
    uint capacity;
    uint top;                  // the coarsest level
    uvec4 first_of_level;      // block, from level 1
} push;

// A step ends so far behind the edge that it goes to, texels.
const float BEYOND = 1e-3;

uint steps = 0u;
bool cut_off = false;

void meet_list(uint first, ListView view, vec2 center, ViewRay along, PhotonRay ray, inout NodeHit nearest) {
    Column column = column_of(view, center);
    uint index = first;
    FOR_NODES_OF_LIST(index) {
        uvec4 node = texelFetch(list_nodes, int(index));
        take_nearer(nearest, distance_to_node(node, view, column, center, MARCH_COLUMN, along, ray), node);
        index = node.z;
    }
}

void march(uint view_index, PhotonRay ray, inout NodeHit nearest) {
    ListView view = load_list_view(list_views, view_index);
    ViewRay along = view_ray(view, ray);
    vec2 range = clip_to_view(view, along, float(push.resolution), nearest.distance);
    float slices_per_meter = SLICES / view.far;
    uint level = push.top;
    float t = range.x;
    // A straight way crosses at most 2·resolution edges between texels. Each is an advance, after which the march rises by a level at most, and
    // every other step sinks one. As many again are for edges that rounding has it meet twice.
    uint most = steps + 8u * push.resolution + 2u * push.top;
    while (t < min(range.y, nearest.distance)) {
        ++steps;
        vec3 at = along.start + t * along.step;
        vec2 texel = at.xy / at.z;
        if (steps > most || !is_finite(texel.x + texel.y)) {
            cut_off = true;
            return;
        }
        vec2 speed = (along.step.xy - texel * along.step.z) / at.z;
        float fastest = max(max(abs(speed.x), abs(speed.y)), 1e-20);
        vec2 probe = clamp(texel + speed * (BEYOND / fastest), vec2(0.0), vec2(float(push.resolution) - 0.5));

        uint shift = LEVEL_BITS * level;
        uvec2 cell = uvec2(probe) >> shift;
        vec2 edge = vec2((cell + uvec2(greaterThan(speed, vec2(0.0)))) << shift);
        vec2 crossing = (edge * along.start.z - along.start.xy) / (along.step.xy - edge * along.step.z);
        // A ray that stands still along an axis never gets to that edge.
        crossing = mix(vec2(range.y), crossing, greaterThan(abs(speed), vec2(1e-6 * fastest)));
        bool x_first = crossing.x < crossing.y;
        // Ahead by a number at least, where the sum rounds to `t`.
        float ahead = max(t + BEYOND / fastest, uintBitsToFloat(floatBitsToUint(t) + 1u));
        float next = min(max(min(crossing.x, crossing.y), ahead), range.y);

        // Hits in a widened column lie a little before or behind the texel.
        float slack = (MARCH_COLUMN - 0.5) / fastest;
        vec2 depths = along.depth + vec2(t - slack, next + slack) * along.depth_step;
        float low = min(depths.x, depths.y);
        float high = max(depths.x, depths.y);
        bool occupied;
        if (level > 0u) {
            uint side = blocks_of_level(push.resolution, level);
            uint block = push.first_of_level[level - 1u] + (view_index * side + cell.y) * side + cell.x;
            uvec4 touched = texelFetch(blocks, int(block)) & slices_between(low * slices_per_meter, high * slices_per_meter);
            occupied = touched != uvec4(0u);
        } else {
            uint row = view_index * push.resolution + cell.y;
            uvec4 list = texelFetch(list_pixels, int(row * push.resolution + cell.x));
            meet_list(list.x, view, vec2(cell) + 0.5, along, ray, nearest);
            occupied = false;
        }
        if (occupied) {
            --level;
        } else {
            // The next cell may belong to another block of the coarser level.
            uint at_edge = uint(x_first ? edge.x : edge.y) >> shift;
            level += uint((at_edge & 3u) == 0u && level < push.top);
            t = next;
        }
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    uint count = min(counts[STAGE_WORDS * push.stage + COUNT_WORD], push.capacity);
    bool missed = false;
    if (index < count) {
        PhotonRay ray = load_photon_ray(rays, index);
        NodeHit nearest = NodeHit(NO_HIT_DISTANCE, 0u, 0u);
        for (uint view = 0u; view < push.view_count; ++view) {
            march(view, ray, nearest);
        }
        missed = nearest.distance == NO_HIT_DISTANCE;
        hits[4u * index] = missed ? HIT_NONE : floatBitsToUint(nearest.distance);
        hits[4u * index + 1u] = nearest.normal;
        hits[4u * index + 2u] = nearest.material;
        hits[4u * index + 3u] = NO_TRIANGLE;
    }
    uint all_steps = subgroupAdd(steps);
    uint misses = subgroupAdd(uint(missed));
    uint cuts = subgroupAdd(uint(cut_off));
    if (subgroupElect()) {
        atomicAdd(work[0], all_steps);
        atomicAdd(work[1], misses);
        if (cuts > 0u) {
            atomicAdd(work[2], cuts);
        }
    }
}
