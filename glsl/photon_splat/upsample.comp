#version 460
#include "lib/prelude.glsl"
#include "photon_splat/answer.glsl"
#include "photon_splat/receiver.glsl"
#include "photon_splat/listed_tile.glsl"

// The slot `caustics` of the pixels of one tile of samples: their irradiance, interpolated between samples of the same surface (Quyen 2014,
// section 3.3.2.4), times what the surface answers.
//
//   E = Σ_j w_j·E_j / Σ_j w_j      w_j = bilinear · ((n·n_j)⁺)¹⁶ · (1 − 2|n·(x_j − x)|/f)⁺
//
// f is the distance of samples at x. In the paper the last factor is 1/(1 + |Δdepth|), which depends on the unit of length and darkens
// slanted planes. The bilinear weight is that of the 2×2 samples around; where none of them is of the pixel's surface, all of the
// 3×3 count alike; where none of these is either, nothing arrives.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D surface;
layout(set = 0, binding = 3) uniform sampler2D specular;
layout(set = 0, binding = 4) uniform usamplerBuffer state;
layout(set = 0, binding = 5) uniform usamplerBuffer tiles;
layout(set = 0, binding = 6) uniform sampler2D irradiance;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2D result;

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    int downscale;
    uint has_specular;
    uint list;
} push;

const float LEAST_WEIGHT = 1e-3;

// The irradiance of a sample times the share of its weight that surfaces decide, and that share.
vec4 weighed(Receiver at, float extent, ivec2 place) {
    ivec2 pixel = pixel_of_sample(place, push.image_size, push.downscale);
    Receiver other = load_receiver(camera, depth, surface, pixel, push.image_size);
    float height = abs(dot(at.normal, other.position_rs - at.position_rs));
    float cosine = max(dot(at.normal, other.normal), 0.0);
    float power = cosine * cosine;
    power *= power;
    power *= power;
    float weight = other.valid ? power * power * max(1.0 - 2.0 * height / extent, 0.0) : 0.0;
    return vec4(texelFetch(irradiance, place, 0).rgb, 1.0) * weight;
}

vec3 interpolated(Receiver at, float extent, ivec2 pixel) {
    ivec2 size = lattice_size(push.image_size, push.downscale);
    vec2 place = splat_coordinates(vec2(pixel) + 0.5, push.downscale) - 0.5;
    ivec2 low = ivec2(floor(place));
    vec2 part = place - vec2(low);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 weights = mix(1.0 - part, part, vec2(corner));
        sum += weights.x * weights.y * weighed(at, extent, clamp(low + corner, ivec2(0), size - 1));
    }
    if (sum.w < LEAST_WEIGHT) {
        ivec2 middle = ivec2(floor(place + 0.5));
        for (int i = 0; i < 9; ++i) {
            sum += LEAST_WEIGHT * weighed(at, extent, clamp(middle + ivec2(i % 3, i / 3) - 1, ivec2(0), size - 1));
        }
    }
    return sum.w > 0.0 ? sum.rgb / sum.w : vec3(0.0);
}

void main() {
    int tile = listed_tile(state, tiles, push.list);
    if (tile == NO_TILE) {
        return;
    }
    int columns = tiles_a_row(lattice_size(push.image_size, push.downscale));
    ivec2 corner = TILE_SIDE * push.downscale * ivec2(tile % columns, tile / columns);
    vec2 steps = 2.0 * vec2(length(camera.right_scaled), length(camera.down_scaled)) / vec2(push.image_size);
    for (int part = 0; part < 4 * push.downscale * push.downscale; ++part) {
        ivec2 block = ivec2(part >> 2) / ivec2(1, push.downscale) % push.downscale;
        ivec2 pixel = corner + TILE_SIDE * block + sample_of_invocation(gl_LocalInvocationIndex, part & 3);
        if (is_inside(pixel, push.image_size)) {
            Receiver at = load_receiver(camera, depth, surface, pixel, push.image_size);
            float along = camera.depth_range > 0.0 ? 1.0 : dot(at.position_rs - camera.position_rs, camera.forward);
            float extent = max(steps.x, steps.y) * along * float(push.downscale);
            vec3 light = at.valid ? interpolated(at, extent, pixel) : vec3(0.0);
            vec4 lobe = push.has_specular != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
            imageStore(result, pixel, vec4(answer(light, texelFetch(surface, pixel, 0), lobe), 1.0));
        }
    }
}
