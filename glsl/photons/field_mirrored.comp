#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "lib/exact_sum.glsl"
#include "lib/mirrored.glsl"
#include "photons/field.glsl"

// The irradiance of caustics at one point x that mirrors and glass show, W/m², as a pixel at x has it (photon_splat/disc.glsl):
//
//   E(x) = Σ_p Φ_p · K(q_p)/(h_p·h'_p) · (n_x·n_p)⁺        ∫ K = 1 over the unit disc
//
// over the photons p whose ellipses reach x, q the distance in the ellipse's plane over its radius. Photons stand in another order from run to run: what they give is
// summed up in whole numbers.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) uniform usamplerBuffer lengths;
layout(set = 0, binding = 3) uniform usamplerBuffer order;
layout(set = 0, binding = 4) uniform usamplerBuffer state;
layout(set = 0, binding = 5) writeonly buffer Received { vec4 received[]; };

layout(push_constant, scalar) uniform Push {
    float inverse_coarsest;  // 1/m
    float tolerance;         // metres that a photon may be off its surface
    float most_listed;       // in a bucket
    uint bucket_mask;
} push;

// Steps that the brightest photon is counted in: 2^23 of them stay below 2^63.
const int STEP_BITS = 40;

float steps_a_unit() {
    int exponent = max(int(texelFetch(state, int(STATE_PEAK)).x >> 23) - 126, -80);
    return uintBitsToFloat(uint(127 + STEP_BITS - exponent) << 23);
}

// What one photon gives.
vec3 light_of(int photon, vec3 offset, vec3 normal) {
    uvec4 light = texelFetch(photons, photon + 1);
    float inverse_squared_radius = uintBitsToFloat(light.w);
    float height_limit = allowed_height(inversesqrt(inverse_squared_radius), push.tolerance);
    if (dot(offset, offset) >= 1.0 / inverse_squared_radius + height_limit * height_limit) {
        return vec3(0.0);
    }
    uvec4 shape = texelFetch(photons, photon + 2);
    vec3 disc_normal = unpack_direction(shape.w);
    float cosine = dot(normal, disc_normal);
    float height = dot(offset, disc_normal);
    float squeezed = dot(offset, uintBitsToFloat(shape.xyz));
    float squared = max(dot(offset, offset) - height * height, 0.0) * inverse_squared_radius + squeezed * squeezed;
    bool lit = squared < 1.0 && cosine > LEAST_COSINE && abs(height) < height_limit;
    return lit ? uintBitsToFloat(light.xyz) * (gaussian_shape(squared) * cosine) : vec3(0.0);
}

vec3 irradiance_at(vec3 position, vec3 normal) {
    float scale = steps_a_unit();
    Sum sum = NO_SUM;
    uint levels = texelFetch(state, int(STATE_LEVELS)).x;
    [[dont_unroll]] while (levels != 0u) {
        uint level = uint(findLSB(levels));
        levels &= levels - 1u;
        float side = uintBitsToFloat((127u - level) << 23) / push.inverse_coarsest;
        ivec3 low = cell_of(position - 0.5 * side, level, push.inverse_coarsest);
        [[dont_unroll]] for (uint corner = 0u; corner < 8u; ++corner) {
            ivec3 cell = low + ivec3(corner & 1u, corner >> 1 & 1u, corner >> 2);
            int bucket = int(bucket_of_cell(cell, level, push.bucket_mask));
            int first = int(texelFetch(starts, bucket).x);
            int end = first + int(texelFetch(lengths, bucket).x);
            float stands_for = max(float(int(texelFetch(starts, bucket + 1).x) - first) / push.most_listed, 1.0);
            [[dont_unroll]] for (int listed = first; listed < end; ++listed) {
                int photon = int(FIELD_TEXELS * texelFetch(order, listed).x);
                uvec4 place = texelFetch(photons, photon);
                vec3 middle = uintBitsToFloat(place.xyz);
                if (place.w == level && cell_of(middle, level, push.inverse_coarsest) == cell) {
                    add(sum, light_of(photon, position - middle, normal) * (stands_for * scale));
                }
            }
        }
    }
    return steps_of(sum) / scale;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Mirrored point = load_mirrored(mirrored_points, index);
    bool answers = !point.first && max3(indirect_diffuse_albedo(point.surface)) > 0.0;
    received[index] = vec4(answers ? irradiance_at(point.surface.position_rs, point.surface.geometric_normal) : vec3(0.0), 0.0);
}
