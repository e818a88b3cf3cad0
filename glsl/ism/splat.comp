#version 460
#include "lib/prelude.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "ism/map.glsl"
#include "lib/vpl.glsl"

// One invocation draws one point of the scene's surfaces into the map of one VPL (Ritschel et al. 2008). The point stands for a disc in its
// triangle's plane, of the area that the points of a set share; it covers the texels whose centres see the disc or lie close to the point as
// seen from the VPL. Each keeps the nearest surface: an atomic maximum of the inverse distance [1/m], whose bits order as its values.
//
// Discs of more than 2x2 texels are left to several invocations, a texel each, so that nobody waits for a near point's: to those of a subgroup
// where these run in step, else to teams that share the discs through the group's memory. Either way every texel gets the same maximum.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer vpls;
layout(set = 0, binding = 1) uniform samplerBuffer points;
layout(set = 0, binding = 2) uniform samplerBuffer area_before;
layout(set = 0, binding = 3) buffer Drawn { uint drawn[]; };

// Whether a subgroup's invocations run in step (src/vulkan/traits.rs).
layout(constant_id = 0) const uint IN_STEP = 0u;

layout(push_constant, scalar) uniform Push {
    uint vpl_count;
    uint points_of_set;
    uint set_count;
    uint resolution;
    uint block_count;
} push;

// Area of the discs over that of the surfaces. At 1 a third of a near wall is not covered, and what is behind shows through.
const float OVERLAP = 2.0;
// How far from a texel's centre a point of no extent is drawn, in texels.
const float LEAST_EXTENT = 0.4;

// Neighbouring invocations that draw a disc together.
const uint TEAM = 8u;
const uint TEAMS = gl_WorkGroupSize.x / TEAM;

// Points whose discs are left to teams, and their number, of three VPLs in turn: while teams draw those of one, others write down those of the next
// and the count of the one after is set to zero, so that one barrier a VPL does.
shared uint large_points[3][gl_WorkGroupSize.x];
shared uint large_counts[3];

// A point in the frame of a map (glsl/ism/map.glsl).
struct Disc {
    vec3 toward;        // unit
    vec3 plane;         // n/(n·p): the inverse distance along ω is plane·ω
    float distance;
    float least_cosine;
    ivec2 low;   // texels that it may cover
    ivec2 size;  // 0: none
};

Disc disc_of_point(vec4 point, Vpl vpl, float radius) {
    vec3 normal = vpl.normal * inversesqrt(dot(vpl.normal, vpl.normal));
    vec3 position = to_map_frame(normal, point.xyz - vpl.position_rs);
    vec3 plane = to_map_frame(normal, normalize(unpack_direction_in_float_unnormalized(point.w)));
    float height = dot(plane, position);
    float resolution = float(push.resolution);
    Disc disc;
    disc.distance = max(length(position), 1e-20);
    disc.toward = position / disc.distance;
    disc.plane = plane / height;
    float above = disc.distance + position.z;
    vec2 center = position.xy / max(above, 1e-20);
    float spread = 1.0 + dot(center, center);
    float least_angle = LEAST_EXTENT * 4.0 / (resolution * spread);
    disc.least_cosine = 1.0 - 0.5 * least_angle * least_angle;
    float extent = max(min(radius / disc.distance, 4.0) * 0.52 * spread, 2.2 * LEAST_EXTENT / resolution);
    ivec2 last = ivec2(int(push.resolution) - 1);
    disc.low = clamp(ivec2(floor((0.5 * (center - extent) + 0.5) * resolution)), ivec2(0), last);
    ivec2 high = clamp(ivec2(floor((0.5 * (center + extent) + 0.5) * resolution)), ivec2(0), last);
    // Below the map, or so close to edge-on that it hides nothing: the VPL's own surface is.
    bool hides = point.w > 0.0 && max3(vpl.strength) > 0.0 && above > 0.3 * disc.distance && abs(height) > 0.01 * disc.distance;
    disc.size = hides ? high - disc.low + 1 : ivec2(0);
    return disc;
}

void draw_texel(uint first, ivec2 texel, vec3 toward, vec3 plane, float distance, float least_cosine, float radius) {
    vec3 direction = direction_of_map(center_of_texel(texel, float(push.resolution)));
    float inverse = dot(plane, direction);
    float cosine = dot(direction, toward);
    // The way from the point to where the direction meets its plane, over the distance of that, squared.
    float share = inverse * distance;
    float off = 1.0 + share * (share - 2.0 * cosine);
    if (inverse > 0.0 && (off <= radius * radius * inverse * inverse || cosine >= least_cosine)) {
        uint place = first + uint(texel.y) * push.resolution + uint(texel.x);
        atomicMax(drawn[place], floatBitsToUint(min(inverse, 2.0 / distance)));
    }
}

// By all invocations of the subgroup: of each one's disc that is `large` every texel, by turns.
void draw_in_step(uint first, Disc disc, bool large, float radius) {
    uvec4 waiting = subgroupBallot(large);
    while (subgroupBallotBitCount(waiting) > 0u) {
        uint lane = subgroupBallotFindLSB(waiting);
        waiting[lane >> 5] &= waiting[lane >> 5] - 1u;
        vec3 toward =
            vec3(subgroupShuffle(disc.toward.x, lane), subgroupShuffle(disc.toward.y, lane), subgroupShuffle(disc.toward.z, lane));
        vec3 plane = vec3(subgroupShuffle(disc.plane.x, lane), subgroupShuffle(disc.plane.y, lane), subgroupShuffle(disc.plane.z, lane));
        float distance = subgroupShuffle(disc.distance, lane);
        float least_cosine = subgroupShuffle(disc.least_cosine, lane);
        ivec2 low = ivec2(subgroupShuffle(disc.low.x, lane), subgroupShuffle(disc.low.y, lane));
        ivec2 size = ivec2(subgroupShuffle(disc.size.x, lane), subgroupShuffle(disc.size.y, lane));
        for (int index = int(gl_SubgroupInvocationID); index < size.x * size.y; index += int(gl_SubgroupSize)) {
            draw_texel(first, low + ivec2(index % size.x, index / size.x), toward, plane, distance, least_cosine, radius);
        }
    }
}

vec4 point_of_set(uint set, uint number) {
    return number < push.points_of_set ? texelFetch(points, int(set * push.points_of_set + number)) : vec4(0.0);
}

// By all invocations of the group, in the `turn` of the VPL of that number.
void draw_by_teams(uint first, uint set, Vpl vpl, bool large, float radius, uint turn) {
    if (large) {
        large_points[turn][atomicAdd(large_counts[turn], 1u)] = gl_GlobalInvocationID.x;
    }
    if (gl_LocalInvocationIndex == 0u) {
        large_counts[(turn + 1u) % 3u] = 0u;
    }
    barrier();
    uint large_count = large_counts[turn];
    for (uint waiting = gl_LocalInvocationIndex / TEAM; waiting < large_count; waiting += TEAMS) {
        Disc disc = disc_of_point(point_of_set(set, large_points[turn][waiting]), vpl, radius);
        for (int index = int(gl_LocalInvocationIndex % TEAM); index < disc.size.x * disc.size.y; index += int(TEAM)) {
            ivec2 texel = disc.low + ivec2(index % disc.size.x, index / disc.size.x);
            draw_texel(first, texel, disc.toward, disc.plane, disc.distance, disc.least_cosine, radius);
        }
    }
}

void main() {
    float area = texelFetch(area_before, int(push.block_count)).x / float(push.points_of_set);
    float radius = sqrt(area * (OVERLAP * INVERSE_PI));
    if (IN_STEP == 0u) {
        if (gl_LocalInvocationIndex == 0u) {
            large_counts[0] = 0u;
        }
        barrier();
    }
    uint turn = 0u;
    for (uint k = gl_WorkGroupID.y; k < push.vpl_count; k += gl_NumWorkGroups.y) {
        uint first = k * push.resolution * push.resolution;
        uint set = k % push.set_count;
        Vpl vpl = unpack_vpl(texelFetch(vpls, 2 * int(k)), texelFetch(vpls, 2 * int(k) + 1));
        Disc disc = disc_of_point(point_of_set(set, gl_GlobalInvocationID.x), vpl, radius);
        bool large = max(disc.size.x, disc.size.y) > 2;
        int small = large ? 0 : disc.size.x * disc.size.y;
        for (int index = 0; index < small; ++index) {
            ivec2 within = disc.size.x == 2 ? ivec2(index & 1, index >> 1) : ivec2(0, index);
            draw_texel(first, disc.low + within, disc.toward, disc.plane, disc.distance, disc.least_cosine, radius);
        }
        if (IN_STEP != 0u) {
            draw_in_step(first, disc, large, radius);
        } else {
            draw_by_teams(first, set, vpl, large, radius, turn);
            turn = turn < 2u ? turn + 1u : 0u;
        }
    }
}
