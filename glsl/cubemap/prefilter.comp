#version 460
#include "lib/prelude.glsl"
#include "cubemap/cube.glsl"
#include "lib/microfacet.glsl"

// What the GGX lobe of one level's α shows of the map around one direction r, as if seen along its normal (n = v = r; Karis 2013):
//
//   L(r) = ∫ L(l) f cos dω / ∫ f cos dω = Σ G₁(l) L(l) / Σ G₁(l),     l = 2(r·h)h − r,  h ~ D(h) h·n
//
// Samples are the same around each direction, and each reads the mean over the solid angle that it stands for, 4/(N·D) (Křivánek & Colbert 2008): levels
// have no noise, and a uniform light has the same radiance in all of them.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer boxes;
layout(set = 0, binding = 1) writeonly buffer Lobes { vec4 lobes[]; };

// The finest level has narrow lobes, and most of the texels.
const uint FINEST_SAMPLES = 64u;
const uint SAMPLES = 256u;
// Squares that a sample reads over those that it stands for: neighbours overlap.
const float OVERLAP = 2.0;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= first_of_lobes(LOBE_LEVELS)) {
        return;
    }
    uint level = 0u;
    [[dont_unroll]] while (level + 1u < LOBE_LEVELS && index >= first_of_lobes(level + 1u)) {
        ++level;
    }
    float alpha = alpha_of_lobes(level);
    Frame frame = frame_around(normalize(direction_of_texel(index - first_of_lobes(level), side_of_lobes(level))));
    float texel = 4.0 / float(CUBE_SIDE * CUBE_SIDE);  // sr, in the middle of a face
    uint samples = level == 0u ? FINEST_SAMPLES : SAMPLES;
    vec4 sum = vec4(0.0);
    [[dont_unroll]] for (uint i = 0u; i < samples; ++i) {
        float share = (float(i) + 0.5) / float(samples);
        float azimuth = 2.0 * PI * float(bitfieldReverse(i) >> 8) / 16777216.0;
        float cosine2 = (1.0 - share) / (1.0 + (alpha * alpha - 1.0) * share);
        float across = sqrt(1.0 - cosine2);
        vec3 middle = vec3(across * cos(azimuth), across * sin(azimuth), sqrt(cosine2));
        vec3 local = 2.0 * middle.z * middle - vec3(0.0, 0.0, 1.0);
        if (local.z <= 0.0) {
            continue;
        }
        vec3 direction = to_world(frame, local);
        float largest = max3(abs(direction));
        float density = 0.25 * float(samples) * ggx_distribution(middle, alpha);
        float covered = OVERLAP / (density * texel * largest * largest * largest);
        uint read = uint(clamp(0.5 * log2(max(covered, 1e-20)) + 0.5, 0.0, float(BOX_LEVELS - 1u)));
        float weight = smith_masking(local.z, alpha);
        sum += weight * vec4(bilinear(boxes, first_of_boxes(read), side_of_boxes(read), direction).rgb, 1.0);
    }
    lobes[index] = vec4(sum.rgb / sum.w, 1.0);
}
