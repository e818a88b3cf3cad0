#version 460
#include "lib/prelude.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "photon_lists/hit.glsl"
#include "photon_lists/slices.glsl"

// The nearest surface that one photon meets, by a march over the texels that its ray crosses in each view (a DDA in homogeneous coordinates, so that
// perspective needs no other), past blocks in whose slices of depth the ray meets no surface (photon_lists/slices.glsl). Distances in m.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer rays;
layout(set = 0, binding = 1) uniform samplerBuffer views;
layout(set = 0, binding = 2) uniform usamplerBuffer pixels;
layout(set = 0, binding = 3) uniform usamplerBuffer nodes;
layout(set = 0, binding = 4) uniform usamplerBuffer blocks;
layout(set = 0, binding = 5) readonly buffer Counts { uint counts[]; };
layout(set = 0, binding = 6) writeonly buffer Hits { uint hits[]; };
layout(set = 0, binding = 7) buffer Work { uint work[]; };  // steps, misses

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

void meet_list(uint first, ListView view, vec2 center, ViewRay along, PhotonRay ray, inout NodeHit nearest) {
    Column column = column_of(view, center);
    uint index = first;
    while (index != NO_NODE) {
        uvec4 node = texelFetch(nodes, int(index));
        meet_node(node, view, column, center, along, ray, nearest);
        index = node.z;
    }
}

// A place on the way through a view.
struct Step {
    float t;      // m along the ray
    uint level;
    uvec2 texel;  // of level 0
    uint list;    // the texel's first node; NO_NODE: there is nothing to meet
};

// Goes on past cells of the present level, to a coarser one behind its edge, to a finer one where the cell's slices may hold a hit.
void advance(inout Step at, ListView view, uint view_index, ViewRay along, float end) {
    vec3 position = along.start + at.t * along.step;
    vec2 texel = position.xy / position.z;
    vec2 speed = (along.step.xy - texel * along.step.z) / position.z;
    float fastest = max(max(abs(speed.x), abs(speed.y)), 1e-20);
    vec2 probe = clamp(texel + speed * (BEYOND / fastest), vec2(0.0), vec2(float(push.resolution) - 0.5));

    uint shift = LEVEL_BITS * at.level;
    uvec2 cell = uvec2(probe) >> shift;
    vec2 edge = vec2((cell + uvec2(greaterThan(speed, vec2(0.0)))) << shift);
    vec2 crossing = (edge * along.start.z - along.start.xy) / (along.step.xy - edge * along.step.z);
    // A ray that stands still along an axis never gets to that edge.
    crossing = mix(vec2(end), crossing, greaterThan(abs(speed), vec2(1e-6 * fastest)));
    float next = min(max(min(crossing.x, crossing.y), at.t + BEYOND / fastest), end);

    // Hits in a widened column lie up to half a texel before or behind it.
    float slack = (COLUMN - 0.5) / fastest;
    vec2 depths = along.depth + vec2(at.t - slack, next + slack) * along.depth_step;
    float low = min(depths.x, depths.y);
    float high = max(depths.x, depths.y);
    bool descends = false;
    if (at.level > 0u) {
        uint side = blocks_of_level(push.resolution, at.level);
        uint block = push.first_of_level[at.level - 1u] + (view_index * side + cell.y) * side + cell.x;
        uvec4 touched = texelFetch(blocks, int(block)) & slices_between(low * SLICES / view.far, high * SLICES / view.far);
        descends = touched != uvec4(0u);
    } else {
        uint row = view_index * push.resolution + cell.y;
        uvec4 list = texelFetch(pixels, int(row * push.resolution + cell.x));
        at.texel = cell;
        at.list = list.x;
    }
    if (descends) {
        --at.level;
    } else {
        // The next cell may belong to another block of the coarser level.
        uint at_edge = uint(crossing.x < crossing.y ? edge.x : edge.y) >> shift;
        at.level += uint((at_edge & 3u) == 0u && at.level < push.top);
        at.t = next;
    }
}

// First all rays of a subgroup go on to a texel with a list, then all walk theirs: the two kinds of work do not wait for each other.
void march(uint view_index, PhotonRay ray, inout NodeHit nearest) {
    ListView view = load_list_view(views, view_index);
    ViewRay along = view_ray(view, ray);
    vec2 range = clip_to_view(view, along, float(push.resolution), nearest.distance);
    Step at = Step(range.x, push.top, uvec2(0u), NO_NODE);
    while (at.t < min(range.y, nearest.distance)) {
        at.list = NO_NODE;
        while (at.list == NO_NODE && at.t < range.y) {
            advance(at, view, view_index, along, range.y);
            ++steps;
        }
        meet_list(at.list, view, vec2(at.texel) + 0.5, along, ray, nearest);
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
    if (subgroupElect()) {
        atomicAdd(work[0], all_steps);
        atomicAdd(work[1], misses);
    }
}
