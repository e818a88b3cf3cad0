#version 460
#include "lib/prelude.glsl"
#include "photon_splat/answer.glsl"
#include "photon_splat/disc.glsl"
#include "photon_splat/fixed_point.glsl"
#include "photon_splat/levels.glsl"
#include "photon_splat/receiver.glsl"
#include "photon_splat/listed_tile.glsl"

// The caustic irradiance of one sample, E(x) = Σ_p Φ_p·K(d_p/h_p)/h_p² (photon_splat/disc.glsl), over the photons in the cells around it.
// At full size the slot `caustics` in W/(m²·sr) (photon_splat/answer.glsl), else E in W/m² for upsample.comp. Quyen 2014, section 3.3.2.3,
// gathered instead of blended.

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

// Each term is at most 2^26, each sum of MOST_TERMS of them below 2^32; then they go into 64 bits.
const int TERM_BITS = 26;
const int MOST_TERMS = 32;

uvec3 sum_low = uvec3(0u);
uvec3 sum_high = uvec3(0u);

void add_run(Receiver receiver, int first, int end, float scale) {
    uvec3 sum = uvec3(0u);
    for (int index = first; index < end; ++index) {
        vec4 place = uintBitsToFloat(texelFetch(sorted_discs, 2 * index));
        vec3 offset = (receiver.position_rs - place.xyz) * place.w;
        float height_limit = allowed_height(place.w, push.tolerance);
        if (dot(offset, offset) < 1.0 + height_limit * height_limit) {
            uvec4 disc = texelFetch(sorted_discs, 2 * index + 1);
            float weight = scale * disc_weight(offset, receiver.normal, unpack_direction(disc.w), height_limit);
            vec3 terms = uintBitsToFloat(disc.xyz) * weight;
            sum += uvec3(to_fixed(terms.x), to_fixed(terms.y), to_fixed(terms.z));
        }
    }
    sum_low += sum;
    sum_high += uvec3(lessThan(sum_low, sum));
}

void add_level(Receiver receiver, ivec2 block, int level, float scale) {
    uvec4 cells = texelFetch(levels, level);
    ivec4 around = cells_around(block, block + ivec2(3, 1), 0.0, level, cells);
    for (int y = around.y; y <= around.w; ++y) {
        int first = int(texelFetch(cell_starts, cell_index(ivec2(around.x, y), cells)).x);
        int end = int(texelFetch(cell_starts, cell_index(ivec2(around.z + 1, y), cells)).x);
        for (; first < end; first += MOST_TERMS) {
            add_run(receiver, first, min(first + MOST_TERMS, end), scale);
        }
    }
}

void main() {
    int tile = listed_tile(state, tiles);
    ivec2 size = lattice_size(push.image_size, push.downscale);
    ivec2 place = sample_of_tile(tile, size);
    if (tile == NO_TILE || !is_inside(place, size)) {
        return;
    }
    ivec2 pixel = pixel_of_sample(place, push.image_size, push.downscale);
    Receiver receiver = load_receiver(camera, depth, surface, pixel, push.image_size);
    float scale = fixed_point_scale(uintBitsToFloat(texelFetch(tile_peaks, tile).x), TERM_BITS);
    if (receiver.valid) {
        uint filled = texelFetch(state, int(STATE_LEVELS)).x;
        ivec2 block = place & ~ivec2(3, 1);
        for (int level = 0; level < push.level_count; ++level) {
            if ((filled >> level & 1u) != 0u) {
                add_level(receiver, block, level, scale);
            }
        }
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
