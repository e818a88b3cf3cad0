#version 460
#include "lib/prelude.glsl"
#include "lib/vectors.glsl"
#include "lightmaps/charts.glsl"
#include "lightmaps/links.glsl"

// One more bounce of the approximated illumination map (AIM): what one texel receives, of the lights and along its links,
//
//   E(x) = E_direct(x) + E_caustic(x) + 1/N Σ_l w_l·E(y_l)        W/m²
//
// with E_caustic what photons bring that met specular lobes alone (send.comp), and w_l the albedo where the link ends, and what mirrors on the way leave of it (links.comp).

layout(local_size_x = 64) in;

// 1: there are such photons.
layout(constant_id = 0) const uint HAS_CAUSTICS = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer direct;
layout(set = 0, binding = 1) uniform usamplerBuffer links;
layout(set = 0, binding = 2) uniform samplerBuffer before;
layout(set = 0, binding = 3) uniform samplerBuffer caustics;
layout(set = 0, binding = 4) writeonly buffer After { vec4 after[]; };

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint link_count;
} push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < push.link_count; ++i) {
        uvec2 link = texelFetch(links, int(i * push.texel_count + number)).xy;
        if (link.x != NO_TEXEL) {
            sum += unpack_share(link.y) * texelFetch(before, int(link.x)).rgb;
        }
    }
    vec3 irradiance = texelFetch(direct, int(number)).rgb + sum / float(push.link_count);
    irradiance += HAS_CAUSTICS != 0u ? texelFetch(caustics, int(number)).rgb : vec3(0.0);
    after[number] = vec4(is_finite(irradiance) ? irradiance : vec3(0.0), 1.0);
}
