#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "lib/mirrored.glsl"
#include "lib/sobol.glsl"
#include "lib/vpl.glsl"

// The irradiance from all virtual point lights, or a range of them, at one point that mirrors show (lib/mirrored.glsl), W/m². Where rays say what is blocked
// only a few lights get one, drawn by what each would give, c_k, and evenly over the sum (systematic sampling):
//
//   E = Σ_k c_k V_k ≈ C/R Σ_r c_k(r)/max c_k(r) · V_k(r),     C = Σ_k max c_k

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer vpls;
layout(set = 0, binding = 1) buffer Received { vec4 received[]; };

#include "vpl/gather.glsl"

layout(push_constant, scalar) uniform Push {
    VplRange range;
    vec3 shift;   // from render space to that of rays
} push;

// Lights of a range that get a ray.
const uint RAYS = 4u;

vec3 unblocked(int k, Receiver receiver, out Vpl vpl) {
    vpl = as_disc(unpack_vpl(texelFetch(vpls, 2 * k), texelFetch(vpls, 2 * k + 1)));
    return vpl.strength * disc_form_factor(vpl, receiver.position_rs, receiver.normal);
}

vec3 gather_few(Receiver receiver) {
    float whole = 0.0;
    Vpl vpl;
    [[dont_unroll]] for (int k = push.range.first; k < push.range.end; ++k) {
        whole += max3(unblocked(k, receiver, vpl));
    }
    uvec3 bits = floatBitsToUint(receiver.position_rs);
    float random = float(mix_bits(bits.x ^ mix_bits(bits.y ^ mix_bits(bits.z))) >> 8) / 16777216.0;
    float step_size = whole / float(RAYS);
    float next = random * step_size;
    float sum = 0.0;
    vec3 irradiance = vec3(0.0);
    [[dont_unroll]] for (int k = push.range.first; k < push.range.end && next < whole; ++k) {
        vec3 part = unblocked(k, receiver, vpl);
        float largest = max3(part);
        sum += largest;
        if (largest > 0.0 && sum > next) {
            float taken = ceil((sum - next) / step_size);
            irradiance += part / largest * (step_size * taken * vpl_visibility(k, vpl, receiver.position_rs, receiver.normal));
            next += step_size * taken;
        }
    }
    return irradiance;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Surface point = load_mirrored(mirrored_points, index).surface;
    vec3 irradiance = vec3(0.0);
    if (max3(point.diffuse_albedo) > 0.0) {
        Receiver receiver = Receiver(point.position_rs - push.shift, point.normal);
        if (VISIBILITY == VISIBILITY_TRACED) {
            irradiance = gather_few(receiver);
        } else {
            gather(push.range, receiver, irradiance);
        }
    }
    vec3 before = push.range.first > 0 ? received[index].rgb : vec3(0.0);
    received[index] = vec4(before + irradiance, 0.0);
}
