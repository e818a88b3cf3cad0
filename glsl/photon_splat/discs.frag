#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "groups/surface.glsl"
#include "photon_splat/fixed_point.glsl"
#include "photon_splat/receiver.glsl"
#include "photon_splat/tile.glsl"
#include "photon_splat/weight.glsl"

// One photon's irradiance at one sample, Φ·K(d/h)/h² (photon_splat/disc.glsl), added to that sample's sum: Quyen 2014, section 3.3.2.3. In
// place of blending, whose rounding depends on the photons' order, sums are 64-bit integers in two words.

layout(early_fragment_tests) in;

layout(set = 0, binding = 2) buffer SumBlock { uint sums[]; };

#include "photon_splat/sums.glsl"

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    int downscale;
    float tolerance;
    ivec2 range;  // of tiles
} push;

layout(location = 0) flat in vec3 center;
layout(location = 1) flat in vec4 irradiance;
layout(location = 2) flat in vec4 disc_normal;
layout(location = 3) flat in vec3 squeeze;

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    ivec2 size = lattice_size(push.image_size, push.downscale);
    ivec2 tile = place / TILE_SIDE;
    int index = tile.y * tiles_a_row(size) + tile.x;
    if (index < push.range.x || index >= push.range.y) {
        return;
    }
    ivec2 pixel = pixel_of_sample(place, push.image_size, push.downscale);
    Receiver receiver = load_receiver(camera, depth, surface, pixel, push.image_size);
    vec3 offset = receiver.position_rs - center;
    float weight = disc_weight(offset, receiver.normal, disc_normal.xyz, disc_normal.w, squeeze, irradiance.w);
    if (receiver.valid && weight > 0.0) {
        float scale = fixed_point_scale(uintBitsToFloat(texelFetch(splat_peaks, index).x));
        add_to_sums(TILE_SAMPLES * (index - push.range.x) + index_in_tile(place), to_fixed(irradiance.xyz * scale, weight), uvec3(0u));
    }
}
