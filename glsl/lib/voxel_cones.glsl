// Whether light of a group of virtual lights reaches a point: a cone from the point around the sphere that holds the group, through voxels (Reich 2015, 4.3.4). With
// s = h·r/D, r the sphere's radius and D its distance, lengths in voxels, the cone is sampled at
//
//   d_0 = 2,   d_{i+1} = max((d_i + d_i·s)/(1 − s), d_i + 1)
//
// in the level whose voxels are w = max(2·d_i·s, 1) wide: equations 4.14 to 4.16 with the aperture as the point sees it, the level by the diameter in place of the radius, and opacity
// α_i, which is that of a way of w, corrected to the way that a sample stands for. A point within the sphere sees it. h (VOXELS_CONE_WIDTH) is 1 in the thesis; filtered samples spread
// twice as wide as a disc of their voxels' width, so that one half meets the penumbra.
//
// Visibility is a product over *occluders*, front to back, of 1 − b, where the thesis (4.17) has one over samples. An occluder is what samples meet without a gap: what hides half of the
// cone hides the same half for as long as the cone runs along it. It blocks b, the most of
//
//   α_i,   α_i + α_{i+1} − α_{i−1} − α_{i+2}
//
// The second is for walls, of which two samples around them meet t and 1 − t: together they block all, and a product would leave t·(1 − t) open, a sixth of the light in the mean.
// What an occluder blocks is forgotten by a fifth with every sample, so that another one behind it counts again.
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
// A wall between two levels' voxels has a little less than 1 in both samples together.
const float CONE_WALL = 1.1;
// Of what an occluder blocks, how much still counts a sample later.
const float CONE_MEMORY = 0.8;
// Visibility that counts as none.
const float CONE_LEAST = 1.0 / 512.0;

// What a cone took: samples of opacity, and steps that it knew to be empty.
struct ConeWork {
    uint samples;
    uint skipped;
};

// What the samples of a cone leave of the light.
struct ConeLight {
    float visibility;
    float blocked;  // by the occluder that the cone is in
    vec3 before;    // the last three samples
};

// Takes the next sample.
void pass_sample(inout ConeLight light, float opacity) {
    float both = light.before.x + light.before.y;
    float occluder = min(max(CONE_WALL * (both - light.before.z - opacity), max(light.before.x, light.before.y)), 1.0);
    float still = CONE_MEMORY * light.blocked;
    if (occluder > still) {
        light.visibility *= (1.0 - occluder) / (1.0 - still);
    }
    light.blocked = max(occluder, still);
    light.before = vec3(opacity, light.before.xy);
}

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

// Where a cone of this length ends, in voxels: within the group's sphere before it starts. `facing`: the cosine between the light's normal and the way to the point.
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
    if (length <= CONE_START) {
        return 1.0;
    }
    vec3 direction = way / length;
    float sine = VOXELS_CONE_WIDTH * min(in_voxels / length, CONE_WIDEST);
    float facing = dot(normal, normal) > 0.0 ? clamp(-dot(normal, direction), 1e-3, 1.0) : 1.0;
    float end = cone_end(length, in_voxels, sine, facing);
    float widest = float(1 << (voxel_grid.levels - 1));
    ConeLight light = ConeLight(1.0, 0.0, vec3(0.0));
    float free_until = 0.0;
    // Steps are a voxel long at least.
    int most_steps = int(dot(vec3(voxel_grid.dims), vec3(1.0)));
    float distance = CONE_START;
    float before = distance - 1.0;
    for (int step = 0; step < most_steps && distance < end && light.visibility > CONE_LEAST; ++step) {
        float diameter = clamp(2.0 * distance * sine, 1.0, widest);
        float next = clamp((distance + distance * sine) / (1.0 - sine), distance + 1.0, distance + widest);
        vec3 place = from + distance * direction;
        // Of the two levels that a sample blends the coarser one has voxels of twice its diameter at most, and all lie within one and a half of them.
        float reach = diameter > 1.0 ? 3.0 * diameter : 1.5;
        if (VOXELS_SKIP_EMPTY != 0u && distance + reach > free_until) {
            free_until = distance + free_distance(place);
        }
        float opacity = 0.0;
        if (VOXELS_SKIP_EMPTY != 0u && distance + reach <= free_until) {
            ++work.skipped;
        } else {
            opacity = cone_opacity(place, direction, diameter) * 0.5 * (next - before) / diameter;
            ++work.samples;
        }
        pass_sample(light, opacity);
        before = distance;
        distance = next;
    }
    pass_sample(light, 0.0);
    pass_sample(light, 0.0);
    return light.visibility > CONE_LEAST ? light.visibility : 0.0;
}

float cone_visibility(vec3 from_rs, vec3 center_rs, float radius, vec3 normal) {
    ConeWork work = ConeWork(0u, 0u);
    return cone_visibility(from_rs, center_rs, radius, normal, work);
}

#endif
