#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "groups/surface.glsl"
#include "photon_splat/answer.glsl"
#include "photon_splat/receiver.glsl"
#include "photon_splat/listed_tile.glsl"

// The slot `caustics` of the pixels between four times 2×2 samples: irradiance, interpolated between samples of the same surface (Quyen 2014,
// section 3.3.2.4), times what the surface answers.
//
//   E = Σ_j w_j·E_j / Σ_j w_j      w_j = bilinear · ((n·n_j)⁺)¹⁶ · (1 − 2|n·(x_j − x)|/f)⁺
//
// f is the distance of samples at x. In the paper the last factor is 1/(1 + |Δdepth|), which depends on the unit of length and darkens
// slanted planes. Where none of the 2×2 samples around is of the pixel's surface, all of the 3×3 count alike; where none of these is
// either, nothing arrives.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D irradiance;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D result;

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    int downscale;
    uint list;
} push;

const float LEAST_WEIGHT = 1e-3;

struct LitSample {
    Receiver surface;
    vec3 irradiance;
};

LitSample load_sample(ivec2 place) {
    place = clamp(place, ivec2(0), lattice_size(push.image_size, push.downscale) - 1);
    ivec2 pixel = pixel_of_sample(place, push.image_size, push.downscale);
    return LitSample(
        load_receiver(camera, depth, surface, pixel, push.image_size), texelFetch(irradiance, place, 0).rgb);
}

// The irradiance of a sample times its weight as far as surfaces decide that, and that weight.
vec4 weighed(Receiver at, LitSample other, float extent) {
    float height = abs(dot(at.normal, other.surface.position_rs - at.position_rs));
    float cosine = max(dot(at.normal, other.surface.normal), 0.0);
    float power = cosine * cosine;
    power *= power;
    power *= power;
    float weight = other.surface.valid ? power * power * max(1.0 - 2.0 * height / extent, 0.0) : 0.0;
    return vec4(other.irradiance, 1.0) * weight;
}

vec3 interpolated(Receiver at, float extent, vec2 place, ivec2 corner, LitSample samples[4]) {
    vec2 part = clamp(place - vec2(corner), 0.0, 1.0);
    vec4 sum = vec4(0.0);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        vec2 weights = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        sum += weights.x * weights.y * weighed(at, samples[i], extent);
    }
    if (sum.w < LEAST_WEIGHT) {
        ivec2 middle = ivec2(floor(place + 0.5));
        [[dont_unroll]] for (int i = 0; i < 9; ++i) {
            sum += LEAST_WEIGHT * weighed(at, load_sample(middle + ivec2(i % 3, i / 3) - 1), extent);
        }
    }
    return sum.w > 0.0 ? sum.rgb / sum.w : vec3(0.0);
}

// The pixels from sample `place` − 1 up to sample `place`, in each direction, and up to the image's edge after the last sample.
void upsample(ivec2 place, ivec2 size) {
    ivec2 corner = place - 1;
    LitSample samples[4];
    [[unroll]] for (int i = 0; i < 4; ++i) {
        samples[i] = load_sample(corner + ivec2(i & 1, i >> 1));
    }
    ivec2 first = max(corner * push.downscale + push.downscale / 2, ivec2(0));
    ivec2 end = place * push.downscale + push.downscale / 2;
    end = min(mix(end, push.image_size, equal(place, size - 1)), push.image_size);
    vec2 steps = 2.0 * vec2(length(camera.right_scaled), length(camera.down_scaled)) / vec2(push.image_size);
    float step_size = max(steps.x, steps.y) * float(push.downscale);
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            ivec2 pixel = ivec2(x, y);
            Receiver at = load_receiver(camera, depth, surface, pixel, push.image_size);
            if (at.valid) {
                float along = camera.depth_range > 0.0 ? 1.0 : dot(at.position_rs - camera.position_rs, camera.forward);
                vec2 pixel_place = splat_coordinates(vec2(pixel) + 0.5, push.downscale) - 0.5;
                vec3 light = interpolated(at, step_size * along, pixel_place, corner, samples);
                vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
                imageStore(result, pixel, vec4(answer(light, texelFetch(surface, pixel, 0), lobe), 1.0));
            }
        }
    }
}

void main() {
    int tile = listed_tile(splat_state, splat_tiles, push.list);
    ivec2 size = lattice_size(push.image_size, push.downscale);
    for (int which = 0; which < 4; ++which) {
        ivec2 place = sample_of_tile(max(tile, 0), size, which);
        if (tile != NO_TILE && is_inside(place, size)) {
            upsample(place, size);
        }
    }
}
