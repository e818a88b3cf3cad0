#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "mirrored/points.glsl"
#include "lib/sobol.glsl"
#include "mirrored/samples.glsl"

// What the sky sends to the diffuse lobe of one listed point, and that to its pixel, by directions spread by the cosine; specular lobes send rays of their own
// (trace/walk.comp).

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    vec3 sky;  // W/(m²·sr)
    uint sample_count;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (!is_listed(index)) {
        return;
    }
    Mirrored point = load_mirrored(mirrored_points, index);
    Receiver receiver = receiver_of(point);
    vec3 radiance = vec3(0.0);
    if (max3(point.surface.diffuse_albedo) > 0.0) {
        Scattering scattering = scattering_of(receiver);
        uint samples = samples_for(push.sample_count, max3(point.weight));
        uvec3 bits = floatBitsToUint(point.surface.position_rs);
        uint seed = seed_of(mix_bits(bits.x ^ mix_bits(bits.y ^ mix_bits(bits.z))), 1u);
        [[dont_unroll]] for (uint i = 0u; i < samples; ++i) {
            vec3 local = sample_cosine_hemisphere(sobol_sample(sobol, i, seed).xy);
            vec3 direction = to_world(scattering.frame, local);
            LobeValue lobe = diffuse_lobe(scattering.matter, scattering.viewer, local, 1.0);
            if (lobe.density > 0.0 && dot(point.surface.geometric_normal, direction) > 0.0 && !is_occluded(receiver.ray_origin, direction, 3e38)) {
                radiance += lobe.value / lobe.density;
            }
        }
        radiance *= push.sky / float(samples);
    }
    add_light(index, point.weight * radiance);
}
