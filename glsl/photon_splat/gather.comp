#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "groups/surface.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "photon_splat/answer.glsl"
#include "photon_splat/fixed_point.glsl"
#include "photon_splat/levels.glsl"
#include "photon_splat/receiver.glsl"
#include "photon_splat/weight.glsl"
#include "photon_splat/listed_tile.glsl"

// The caustic irradiance of four samples, E(x) = Σ_p Φ_p·K(d_p/h_p)/h_p² (photon_splat/disc.glsl), over the photons in the cells around it.
// At full size the slot `caustics` in W/(m²·sr) (photon_splat/answer.glsl), else E in W/m² for upsample.comp. Quyen 2014, section 3.3.2.3,
// gathered instead of blended.
//
// A sphere around the surfaces of a block of 8×4 samples tells which photons its eight invocations look at. Where a subgroup's invocations run in
// step they test eight photons at a time, one each, and all then take those that pass, one after the other; else each tests all for itself. Sums
// are integers: the same bits either way.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer cell_starts;
layout(set = 0, binding = 1) uniform samplerBuffer sorted_centers;
layout(set = 0, binding = 2) uniform samplerBuffer sorted_normals;
layout(set = 0, binding = 3) uniform samplerBuffer sorted_irradiances;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D result;
layout(set = 0, binding = 5) buffer SumBlock { uint sums[]; };
layout(set = 0, binding = 6) uniform samplerBuffer sorted_squeezes;

#include "photon_splat/sums.glsl"

// A group takes one part of the photons of a crowded tile, and adds to `sums` what resolve.comp then makes the result of.
layout(constant_id = 0) const uint CROWDED = 0u;

// Whether a subgroup's invocations run in step (src/vulkan/traits.rs).
layout(constant_id = 1) const uint IN_STEP = 0u;

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    int downscale;
    int level_count;
    ivec2 range;  // of tiles, if crowded
} push;

// Four samples an invocation, which share the loads of a photon.
Receiver receivers[4];
uvec3 sums_low[4];
uvec3 sums_high[4];

// The photons that a block looks through are numbered in the order of its cells: those that come before the next run, and those to take.
int numbered = 0;
int first_taken = 0;
int end_taken = 0x3FFFFFFF;

shared vec3 lows[64];
shared vec3 highs[64];

// A sphere around the surfaces of the invocation's block; a negative radius where there is none.
vec4 bounding_sphere() {
    vec3 low = vec3(1e30);
    vec3 high = vec3(-1e30);
    [[unroll]] for (int which = 0; which < 4; ++which) {
        low = receivers[which].valid ? min(low, receivers[which].position_rs) : low;
        high = receivers[which].valid ? max(high, receivers[which].position_rs) : high;
    }
    lows[gl_LocalInvocationIndex] = low;
    highs[gl_LocalInvocationIndex] = high;
    barrier();
    uint first = gl_LocalInvocationIndex & ~7u;
    [[dont_unroll]] for (uint other = first; other < first + 8u; ++other) {
        low = min(low, lows[other]);
        high = max(high, highs[other]);
    }
    return low.x > high.x ? vec4(0.0, 0.0, 0.0, -1.0) : vec4(0.5 * (low + high), 0.5001 * length(high - low));
}

void add_run(vec4 sphere, int first, int end, float scale) {
    uint width = IN_STEP != 0u ? min(gl_SubgroupSize, 8u) : 1u;
    uint lane = gl_SubgroupInvocationID & (width - 1u);
    uint shift = gl_SubgroupInvocationID - lane;
    for (; first < end; first += int(width)) {
        int candidate = min(first + int(lane), end - 1);
        vec4 around = texelFetch(sorted_centers, candidate);
        vec3 away = around.xyz - sphere.xyz;
        float reach = around.w + sphere.w;
        bool near = fused_dot(away, away) < reach * reach && first + int(lane) < end;
        uint passed = IN_STEP != 0u ? subgroupBallot(near)[shift >> 5] >> (shift & 31u) & ((1u << width) - 1u) : uint(near);
        uvec3 terms[4] = { uvec3(0u), uvec3(0u), uvec3(0u), uvec3(0u) };
        while (passed != 0u) {
            int photon = first + findLSB(passed);
            vec3 center = texelFetch(sorted_centers, photon).xyz;
            vec4 normal = texelFetch(sorted_normals, photon);
            vec4 irradiance = texelFetch(sorted_irradiances, photon);
            vec3 squeeze = ELLIPTIC != 0u ? texelFetch(sorted_squeezes, photon).xyz : vec3(0.0);
            vec3 most = irradiance.xyz * scale;
            [[unroll]] for (int which = 0; which < 4; ++which) {
                vec3 offset = receivers[which].position_rs - center;
                float weight = disc_weight(offset, receivers[which].normal, normal.xyz, normal.w, squeeze, irradiance.w);
                terms[which] += to_fixed(most, weight);
            }
            passed &= passed - 1u;
        }
        [[unroll]] for (int which = 0; which < 4; ++which) {
            sums_low[which] += terms[which];
            sums_high[which] += uvec3(lessThan(sums_low[which], terms[which]));
        }
    }
}

void add_level(vec4 sphere, ivec2 block, int level, float scale) {
    uvec4 cells = texelFetch(splat_levels, level);
    ivec4 around = cells_around(block, block + BLOCK - 1, 0.0, level, cells);
    for (int y = around.y; y <= around.w; ++y) {
        int first = int(texelFetch(cell_starts, cell_index(ivec2(around.x, y), cells)).x);
        int end = int(texelFetch(cell_starts, cell_index(ivec2(around.z + 1, y), cells)).x);
        int number = numbered - first;
        numbered += end - first;
        add_run(sphere, max(first, first_taken - number), min(end, end_taken - number), scale);
    }
}

void store(ivec2 place, vec3 irradiance) {
    vec3 light = irradiance;
    if (push.downscale == 1) {
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, place, 0) : vec4(0.0);
        light = answer(irradiance, texelFetch(surface, place, 0), lobe);
    }
    imageStore(result, place, vec4(light, 1.0));
}

void main() {
    int tile = CROWDED != 0u
        ? tile_in_range(listed_tile(splat_state, splat_tiles, STATE_CROWDED, gl_WorkGroupID.z), push.range)
        : listed_tile(splat_state, splat_tiles, STATE_TILES, gl_WorkGroupID.y);
    if (CROWDED != 0u) {
        first_taken = int(gl_WorkGroupID.y * PART_PHOTONS);
        end_taken = first_taken + int(PART_PHOTONS);
    }
    ivec2 size = lattice_size(push.image_size, push.downscale);
    [[unroll]] for (int which = 0; which < 4; ++which) {
        ivec2 place = sample_of_tile(max(tile, 0), size, which);
        ivec2 pixel = pixel_of_sample(place, push.image_size, push.downscale);
        bool wanted = tile != NO_TILE && is_inside(place, size);
        receivers[which] = load_receiver(camera, depth, surface, wanted ? pixel : ivec2(-1), push.image_size);
        sums_low[which] = uvec3(0u);
        sums_high[which] = uvec3(0u);
    }
    vec4 sphere = bounding_sphere();
    float scale = fixed_point_scale(uintBitsToFloat(texelFetch(splat_peaks, max(tile, 0)).x));
    if (sphere.w >= 0.0) {
        uint filled = texelFetch(splat_state, int(STATE_LEVELS)).x;
        ivec2 block = sample_of_tile(tile, size, 0) & ~(BLOCK - 1);
        for (int level = 0; level < push.level_count; ++level) {
            if ((filled >> level & 1u) != 0u) {
                add_level(sphere, block, level, scale);
            }
        }
    }
    [[unroll]] for (int which = 0; which < 4; ++which) {
        ivec2 place = sample_of_tile(max(tile, 0), size, which);
        if (tile == NO_TILE || !is_inside(place, size)) {
            continue;
        }
        if (CROWDED != 0u) {
            int index = TILE_SAMPLES * (tile - push.range.x) + index_in_tile(gl_LocalInvocationIndex, which);
            add_to_sums(index, sums_low[which], sums_high[which]);
        } else {
            store(place, from_fixed(sums_low[which], sums_high[which], scale));
        }
    }
}
