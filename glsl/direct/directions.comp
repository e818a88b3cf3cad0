#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "direct/receiver.glsl"
#include "lib/emitter_hits.glsl"

// What the sky adds to the slot `direct` of one pixel, estimated from directions drawn as the surface scatters (where it is diffuse
// alone: by the cosine), and what emissive surfaces add that such a direction meets:
//
//   L(x, v) ≈ 1/N Σ_k f(l_k, v) · (n·l_k)⁺ · L / p_k        p: lib/lobes.glsl
//
// The light of emitters is weighted against the points that `emitters` draws, lobe by lobe, by the power heuristic.

layout(local_size_x = 64) in;

// 1: directions look for emitters, not for the sky alone.
layout(constant_id = 3) const uint FINDS_EMITTERS = 0u;

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    uint sample_count;
    vec3 sky;             // W/(m²·sr)
    float density_scale;  // as in emitters.comp
} push;

vec3 light_from(Receiver receiver, LobeSample drawn, vec3 direction) {
    Hit hit = traverse(receiver.ray_origin, direction, 3e38, FINDS_EMITTERS == 0u);
    if (hit.triangle == NO_TRIANGLE) {
        return push.sky;
    }
    if (FINDS_EMITTERS == 0u) {
        return vec3(0.0);
    }
    return weighted_radiance(hit, direction, drawn.density, push.density_scale);
}

vec3 light_of_sample(Receiver receiver, Scattering scattering, vec4 random) {
    LobeSample drawn = sample_lobes(scattering.matter, scattering.viewer, random.z, random.xy);
    vec3 direction = to_world(scattering.frame, drawn.direction);
    if (drawn.density <= 0.0 || max3(drawn.weight) <= 0.0 || dot(receiver.surface.geometric_normal, direction) <= 0.0) {
        return vec3(0.0);
    }
    return drawn.weight * light_from(receiver, drawn, direction);
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(direct);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec3 radiance = vec3(0.0);
    if (pixel_depth > 0.0) {
        Receiver receiver = load_receiver(pixel, size, pixel_depth, push.shift);
        Scattering scattering = scattering_of(receiver);
        uint seed = seed_of(seed_of_pixel(pixel), 1u);
        [[dont_unroll]] for (uint i = 0u; i < push.sample_count; ++i) {
            radiance += light_of_sample(receiver, scattering, sobol_sample(sobol, i, seed));
        }
    }
    store_direct(pixel, radiance / float(push.sample_count));
}
