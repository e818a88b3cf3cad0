#version 460
#include "lib/prelude.glsl"
#include "lib/vectors.glsl"
#include "lightmaps/links.glsl"

// One more bounce of the approximated illumination map (AIM): what one texel receives in one of the maps, of the lights and along its links,
//
//   E(x) = E_direct(x) + E_arrival(x) + E_caustic(x) + 1/N Σ_l w_l·E(y_l)        W/m²
//
// with E_arrival what emissive surfaces and the sky send by way of specular lobes alone (links.comp), E_caustic what photons bring of the other lights that way (send.comp):
// both are scattered once at least, and so come with the first bounce. w_l is the albedo where the link ends, and what mirrors on the way leave of it (links.comp).

layout(local_size_x = 64) in;

// 1: there are such photons.
layout(constant_id = 0) const uint HAS_CAUSTICS = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer direct;
layout(set = 0, binding = 1) uniform usamplerBuffer links;
layout(set = 0, binding = 2) uniform samplerBuffer before;
layout(set = 0, binding = 3) uniform samplerBuffer caustics;
layout(set = 0, binding = 4) uniform samplerBuffer arrivals;
layout(set = 0, binding = 5) writeonly buffer After { vec4 after[]; };

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint link_count;
    vec3 sky;  // W/(m²·sr)
    uint maps;
    uint rest;  // the map that has what comes of emissive surfaces and the sky, the last one; `maps`: there is none
} push;

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place >= push.maps * push.texel_count) {
        return;
    }
    uint number = place % push.texel_count;
    uint map = place / push.texel_count;
    vec3 irradiance = texelFetch(direct, int(place)).rgb;
    if (map == push.rest) {
        irradiance += texelFetch(arrivals, 2 * int(number)).rgb + push.sky * texelFetch(arrivals, 2 * int(number) + 1).rgb;
    }
    irradiance += light_along_links(links, push.texel_count, push.link_count, number, before, map);
    irradiance += HAS_CAUSTICS != 0u ? texelFetch(caustics, int(place)).rgb : vec3(0.0);
    after[place] = vec4(is_finite(irradiance) ? irradiance : vec3(0.0), 1.0);
}
