// Whether light of a group of virtual lights reaches a point: a cone from the point around the sphere that holds the group, through voxels (Reich 2015, 4.3.4). With
// s = h·r/D, r the sphere's radius and D its distance, lengths in voxels, the cone is sampled at
//
//   d_0 = 2,   d_{i+1} = max((d_i + d_i·s)/(1 − s), d_i + 1)
//
// in the level whose voxels are w = max(2·d_i·s, 1) wide, and the samples' opacities α_i are taken off visibility front to back:
//
//   β_i = α_i·(d_{i+1} − d_{i−1})/2w   V_{i+1} = max(V_i − β_i·V_{i−1}, 0)
//
// Equations 4.14 to 4.17 with the aperture as the point sees it, the level by the diameter in place of the radius, and opacity, which is that of a way of w, corrected to the way that a
// sample stands for. A point within the sphere sees it. In place of the product of 1 − α a sample takes its part of what was there before the sample before it: a wall has weight 1 in the two
// samples around it together, t in one and 1 − t in the other, of which the product leaves t·(1 − t) open, a sixth of the light behind it in the mean. h (VOXELS_CONE_WIDTH) is 1 in
// the thesis; filtered samples spread twice as wide as a disc of their voxels' width, so that one half meets the penumbra.
//
// The cone starts two voxels from the point, and ends before the group's own surface: where a sample would reach a plane through the middle with the group's normal,
// or the sphere.
#ifndef LIB_VOXEL_CONES
#define LIB_VOXEL_CONES

#include "groups/voxels.glsl"

// Where a cone starts, in voxels.
const float CONE_START = 2.0;
// No more than this much of the way is the sphere's radius: wider cones take less of it.
const float CONE_WIDEST = 0.9;
// Of a cone's diameter, how far a sample's weights reach from its middle; and how far beyond its plane a surface fills voxels.
const float CONE_SAMPLE_REACH = 1.5;
const float CONE_SURFACE_REACH = 1.5;
// Visibility that counts as none.
const float CONE_LEAST = 1.0 / 512.0;

// What a cone took: samples of opacity, and steps that it knew to be empty.
struct ConeWork {
    uint samples;
    uint skipped;
};

float cone_opacity(vec3 place, vec3 direction, float diameter) {
    vec4 opacity = textureLod(voxel_opacity, place / vec3(voxel_grid.dims), log2(diameter));
    return VOXELS_SEEN_ALONG_AXES != 0u ? dot(opacity.xyz, direction * direction) : opacity.w;
}

// How far around a place no voxel holds anything, along each axis, at least.
float free_distance(vec3 place) {
    ivec3 blocks = blocks_of(voxel_grid.dims);
    ivec3 block = clamp(ivec3(floor(place)) / BLOCK, ivec3(0), blocks - 1);
    int distance = int(texelFetch(voxel_distances, (block.z * blocks.y + block.y) * blocks.x + block.x).x);
    return float((distance - 1) * BLOCK);
}

// Where a cone of this length ends, in voxels. `facing`: the cosine between the light's normal and the way to the point.
float cone_end(float length, float radius, float sine, float facing) {
    float reach = CONE_SAMPLE_REACH;
    float narrow = length - (reach + CONE_SURFACE_REACH) / facing;
    float wide = (length * facing - CONE_SURFACE_REACH) / (facing + 2.0 * sine * reach);
    return min(min(narrow, wide), length - radius);
}

// `from_rs`: the point. `center_rs`, `radius`: the group's sphere, m. `normal`: of the group's surface, zero where it is not known.
float cone_visibility(vec3 from_rs, vec3 center_rs, float radius, vec3 normal, inout ConeWork work) {
    vec3 from = (from_rs - voxel_grid.origin_rs) / voxel_grid.size;
    vec3 way = (center_rs - from_rs) / voxel_grid.size;
    float in_voxels = radius / voxel_grid.size;
    float length = sqrt(dot(way, way));
    if (length <= max(in_voxels, CONE_START)) {
        return 1.0;
    }
    vec3 direction = way / length;
    float sine = VOXELS_CONE_WIDTH * min(in_voxels / length, CONE_WIDEST);
    float facing = dot(normal, normal) > 0.0 ? clamp(-dot(normal, direction), 1e-3, 1.0) : 1.0;
    float end = cone_end(length, in_voxels, sine, facing);
    float widest = float(1 << (voxel_grid.levels - 1));
    float visibility = 1.0;
    float earlier = 1.0;
    float free_until = 0.0;
    // Steps are a voxel long at least.
    int most_steps = int(dot(vec3(voxel_grid.dims), vec3(1.0)));
    float distance = CONE_START;
    float before = distance - 1.0;
    for (int step = 0; step < most_steps && distance < end && visibility > CONE_LEAST; ++step) {
        float diameter = clamp(2.0 * distance * sine, 1.0, widest);
        float next = clamp((distance + distance * sine) / (1.0 - sine), distance + 1.0, distance + widest);
        vec3 place = from + distance * direction;
        // Of the two levels that a sample blends the coarser one has voxels of twice its diameter at most, and all lie within one and a half of them.
        float reach = diameter > 1.0 ? 3.0 * diameter : 1.5;
        if (VOXELS_SKIP_EMPTY != 0u && distance + reach > free_until) {
            free_until = distance + free_distance(place);
        }
        float blocked = 0.0;
        if (VOXELS_SKIP_EMPTY != 0u && distance + reach <= free_until) {
            ++work.skipped;
        } else {
            blocked = cone_opacity(place, direction, diameter) * 0.5 * (next - before) / diameter;
            ++work.samples;
        }
        float after = max(visibility - earlier * min(blocked, 1.0), 0.0);
        earlier = visibility;
        visibility = after;
        before = distance;
        distance = next;
    }
    return visibility > CONE_LEAST ? visibility : 0.0;
}

float cone_visibility(vec3 from_rs, vec3 center_rs, float radius, vec3 normal) {
    ConeWork work = ConeWork(0u, 0u);
    return cone_visibility(from_rs, center_rs, radius, normal, work);
}

#endif
