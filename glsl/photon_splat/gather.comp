#version 460
#include "lib/prelude.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "photon_splat/answer.glsl"
#include "photon_splat/disc.glsl"
#include "photon_splat/fixed_point.glsl"
#include "photon_splat/levels.glsl"
#include "photon_splat/receiver.glsl"
#include "photon_splat/listed_tile.glsl"

// The caustic irradiance of one sample, E(x) = Σ_p Φ_p·K(d_p/h_p)/h_p² (photon_splat/disc.glsl), over the photons in the cells around it.
// At full size the slot `caustics` in W/(m²·sr) (photon_splat/answer.glsl), else E in W/m² for upsample.comp. Quyen 2014, section 3.3.2.3,
// gathered instead of blended.
//
// The eight invocations of a block of 4×2 samples first test eight photons at a time, one each, against a sphere around the block's surfaces;
// all then take those that pass, one after the other.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D surface;
layout(set = 0, binding = 3) uniform sampler2D specular;
layout(set = 0, binding = 4) uniform usamplerBuffer state;
layout(set = 0, binding = 5) uniform usamplerBuffer tiles;
layout(set = 0, binding = 6) uniform usamplerBuffer tile_peaks;
layout(set = 0, binding = 7) uniform usamplerBuffer levels;
layout(set = 0, binding = 8) uniform usamplerBuffer cell_starts;
layout(set = 0, binding = 9) uniform usamplerBuffer sorted_discs;
layout(set = 0, binding = 10, rgba32f) writeonly uniform image2D result;

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    int downscale;
    int level_count;
    uint has_specular;
    float tolerance;
} push;

// Each term is at most 2^28, so that eight of them stay below 2^32; then they go into 64 bits.
const int TERM_BITS = 28;

uvec3 sum_low = uvec3(0u);
uvec3 sum_high = uvec3(0u);

shared vec4 block_points[64];

// A sphere around the surfaces of the invocation's block; a negative radius where there is none.
vec4 bounding_sphere(Receiver receiver) {
    block_points[gl_LocalInvocationIndex] = vec4(receiver.position_rs, receiver.valid ? 1.0 : 0.0);
    barrier();
    uint first = gl_LocalInvocationIndex & ~7u;
    vec3 low = vec3(1e30);
    vec3 high = vec3(-1e30);
    [[dont_unroll]] for (uint other = first; other < first + 8u; ++other) {
        vec4 point = block_points[other];
        low = point.w > 0.0 ? min(low, point.xyz) : low;
        high = point.w > 0.0 ? max(high, point.xyz) : high;
    }
    return low.x > high.x ? vec4(0.0, 0.0, 0.0, -1.0) : vec4(0.5 * (low + high), 0.5001 * length(high - low));
}

void add_photon(Receiver receiver, int index, float scale, inout uvec3 sum) {
    vec4 place = uintBitsToFloat(texelFetch(sorted_discs, 2 * index));
    uvec4 disc = texelFetch(sorted_discs, 2 * index + 1);
    vec3 offset = (receiver.position_rs - place.xyz) * place.w;
    float height_limit = allowed_height(place.w, push.tolerance);
    float weight = scale * disc_weight(offset, receiver.normal, unpack_direction(disc.w), height_limit);
    vec3 terms = uintBitsToFloat(disc.xyz) * weight;
    sum += uvec3(to_fixed(terms.x), to_fixed(terms.y), to_fixed(terms.z));
}

bool may_reach(vec4 place, vec4 sphere) {
    float height_limit = allowed_height(place.w, push.tolerance);
    vec3 offset = (sphere.xyz - place.xyz) * place.w;
    float reach = sqrt(1.0 + height_limit * height_limit) + sphere.w * place.w;
    return dot(offset, offset) < reach * reach;
}

void add_run(Receiver receiver, vec4 sphere, int first, int end, float scale) {
    uint width = min(gl_SubgroupSize, 8u);
    uint lane = gl_SubgroupInvocationID & (width - 1u);
    uint shift = gl_SubgroupInvocationID - lane;
    for (; first < end; first += int(width)) {
        int candidate = min(first + int(lane), end - 1);
        bool near = may_reach(uintBitsToFloat(texelFetch(sorted_discs, 2 * candidate)), sphere) && first + int(lane) < end;
        uint passed = subgroupBallot(near)[shift >> 5] >> (shift & 31u) & ((1u << width) - 1u);
        uvec3 sum = uvec3(0u);
        while (passed != 0u) {
            add_photon(receiver, first + findLSB(passed), scale, sum);
            passed &= passed - 1u;
        }
        sum_low += sum;
        sum_high += uvec3(lessThan(sum_low, sum));
    }
}

void add_level(Receiver receiver, vec4 sphere, ivec2 block, int level, float scale) {
    uvec4 cells = texelFetch(levels, level);
    ivec4 around = cells_around(block, block + ivec2(3, 1), 0.0, level, cells);
    for (int y = around.y; y <= around.w; ++y) {
        int first = int(texelFetch(cell_starts, cell_index(ivec2(around.x, y), cells)).x);
        int end = int(texelFetch(cell_starts, cell_index(ivec2(around.z + 1, y), cells)).x);
        add_run(receiver, sphere, first, end, scale);
    }
}

void main() {
    int tile = max(listed_tile(state, tiles), 0);
    ivec2 size = lattice_size(push.image_size, push.downscale);
    ivec2 place = sample_of_tile(tile, size);
    bool wanted = listed_tile(state, tiles) != NO_TILE && is_inside(place, size);
    ivec2 pixel = pixel_of_sample(place, push.image_size, push.downscale);
    Receiver receiver = load_receiver(camera, depth, surface, wanted ? pixel : ivec2(-1), push.image_size);
    vec4 sphere = bounding_sphere(receiver);
    float scale = fixed_point_scale(uintBitsToFloat(texelFetch(tile_peaks, tile).x), TERM_BITS);
    if (sphere.w >= 0.0) {
        uint filled = texelFetch(state, int(STATE_LEVELS)).x;
        ivec2 block = place & ~ivec2(3, 1);
        for (int level = 0; level < push.level_count; ++level) {
            if ((filled >> level & 1u) != 0u) {
                add_level(receiver, sphere, block, level, scale);
            }
        }
    }
    if (!wanted) {
        return;
    }
    vec3 sum = vec3(
        from_fixed(sum_low.x, sum_high.x, scale), from_fixed(sum_low.y, sum_high.y, scale),
        from_fixed(sum_low.z, sum_high.z, scale));
    if (push.downscale == 1) {
        vec4 lobe = push.has_specular != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        sum = answer(sum, texelFetch(surface, pixel, 0), lobe);
    }
    imageStore(result, place, vec4(sum, 1.0));
}
