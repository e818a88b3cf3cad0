#version 460
#include "lib/prelude.glsl"
#include "lib/finite.glsl"
#include "lib/mirrored.glsl"
#include "lib/vectors.glsl"

// One slot of one marked pixel: the mean of its samples in place of its centre (supersample.comp), always added up in the same order. What shines by itself, and of
// the listed points direct light and, by the irradiance E that some method says, diffuse light and caustics w·ρ/π·E: of first surfaces the slots `direct` and `diffuse`, of what
// mirrors and glass show `specular`.

layout(local_size_x = 64) in;

// What the image shows.
const uint EMISSION = 0u;
const uint DIRECT = 1u;
const uint SPECULAR = 2u;
const uint DIFFUSE = 3u;
layout(constant_id = 0) const uint SLOT = 0u;
// 1: there is diffuse light.
layout(constant_id = 1) const uint HAS_FIELD = 0u;
// 1: there are caustics.
layout(constant_id = 2) const uint HAS_CAUSTICS = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer marked;
layout(set = 0, binding = 1) uniform usamplerBuffer marked_count;  // word 3
layout(set = 0, binding = 2) uniform usamplerBuffer sums;          // emission and the pixel's last point; direct; specular
layout(set = 0, binding = 3) uniform usamplerBuffer points;
layout(set = 0, binding = 4) uniform samplerBuffer light;
layout(set = 0, binding = 5) uniform samplerBuffer irradiance;     // W/m²
layout(set = 0, binding = 6, rgba32f) writeonly uniform image2D image;
layout(set = 0, binding = 7) uniform samplerBuffer caustics;       // W/m²

vec3 light_of_point(int index) {
    Mirrored point = load_mirrored(points, uint(index));
    bool first = SLOT == DIRECT || SLOT == DIFFUSE;
    if (point.first != first) {
        return vec3(0.0);
    }
    vec3 found = SLOT != DIFFUSE ? texelFetch(light, index).rgb : vec3(0.0);
    if ((HAS_FIELD != 0u || HAS_CAUSTICS != 0u) && SLOT != DIRECT) {
        vec3 received = HAS_FIELD != 0u ? texelFetch(irradiance, index).rgb : vec3(0.0);
        received += HAS_CAUSTICS != 0u ? texelFetch(caustics, index).rgb : vec3(0.0);
        found += point.weight * indirect_diffuse_albedo(point.surface) * received * INVERSE_PI;
    }
    return is_finite(found) ? found : vec3(0.0);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(marked_count, 3).x) {
        return;
    }
    vec3 radiance = SLOT != DIFFUSE ? uintBitsToFloat(texelFetch(sums, int(3u * index + SLOT)).xyz) : vec3(0.0);
    if (SLOT != EMISSION) {
        uint next = texelFetch(sums, int(3u * index)).w;
        [[dont_unroll]] while (next != 0u) {
            int point = int(next) - 1;
            radiance += light_of_point(point);
            next = texelFetch(points, 4 * point).w;
        }
    }
    uint packed = texelFetch(marked, int(index)).x;
    imageStore(image, ivec2(packed & 0xFFFFu, packed >> 16), vec4(radiance, 1.0));
}
