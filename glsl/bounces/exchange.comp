#version 460
#include "lib/prelude.glsl"
#include "bounces/samples.glsl"
#include "bounces/sum_of_lanes.glsl"
#include "lib/disc.glsl"

// One group of invocations a sample of the surfaces: the irradiance from all others, which reflect what came to them in the bounce before, W/m²,
//
//   E(s) = Σ_c V_c(s) Σ_{j in c} ρ_j A_j E'_j/π · F_j(s)
//
// F of lib/disc.glsl, V_c a bit for each cluster (bounces/sees.comp); and its sum over all bounces so far. Each invocation takes every 64th cluster.

layout(local_size_x = 64) in;

// 1: light views have lights too, which gave `from_views`.
layout(constant_id = 0) const uint HAS_VIEWS = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer samples;
layout(set = 0, binding = 1) uniform samplerBuffer matter;      // bounces/albedo.comp
layout(set = 0, binding = 2) uniform usamplerBuffer sees;
layout(set = 0, binding = 3) uniform samplerBuffer before;      // E'
layout(set = 0, binding = 4) uniform samplerBuffer sum_before;
layout(set = 0, binding = 5) writeonly buffer ArrivedBlock { vec4 arrived[]; };
layout(set = 0, binding = 7) uniform samplerBuffer from_views;
layout(set = 0, binding = 6) writeonly buffer SumBlock { vec4 sums[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint cluster;
    uint words;
} push;

void main() {
    uint self = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (self >= push.slot_count) {
        return;
    }
    SurfaceSample point = load_sample(samples, self);
    uint clusters = point.area > 0.0 ? push.slot_count / push.cluster : 0u;
    vec3 found = vec3(0.0);
    for (uint cluster = gl_LocalInvocationIndex; cluster < clusters; cluster += 64u) {
        uint word = texelFetch(sees, int(self * push.words + cluster / 32u)).x;
        uint members = (word >> (cluster & 31u) & 1u) != 0u ? push.cluster : 0u;
        for (uint member = 0u; member < members; ++member) {
            uint other = cluster * push.cluster + member;
            vec4 made = texelFetch(matter, int(other));
            vec3 strength = INVERSE_PI * made.w * made.rgb * texelFetch(before, int(other)).rgb;
            if (max3(strength) > 0.0) {
                SurfaceSample from = load_sample(samples, other);
                Vpl disc = Vpl(from.position, made.w * INVERSE_PI, strength, from.normal);
                found += strength * disc_form_factor(disc, point.position, point.normal);
            }
        }
    }
    vec3 sum = sum_of_lanes(found);
    if (gl_LocalInvocationIndex == 0u) {
        if (HAS_VIEWS != 0u) {
            sum += texelFetch(from_views, int(self)).rgb;
        }
        arrived[self] = vec4(sum, 0.0);
        sums[self] = vec4(texelFetch(sum_before, int(self)).rgb + sum, 0.0);
    }
}
