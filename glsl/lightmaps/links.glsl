// Links lead from a texel to those that its rays see: of each (rg32ui) the texel, NO_TEXEL if none, and what share of its irradiance comes along, a colour.
#ifndef LIGHTMAPS_LINKS
#define LIGHTMAPS_LINKS

#include "lightmaps/charts.glsl"

// Three numbers of 9 bits and an exponent (Vulkan's E5B9G9R9).
uint pack_share(vec3 share) {
    vec3 color = clamp(share, vec3(0.0), vec3(65408.0));
    float largest = max(color.x, max(color.y, color.z));
    int exponent = largest > 0.0 ? clamp(int(floor(log2(largest))) + 1, -15, 16) : -15;
    uvec3 steps = min(uvec3(color * exp2(float(9 - exponent)) + 0.5), uvec3(511u));
    return steps.x | steps.y << 9 | steps.z << 18 | uint(exponent + 15) << 27;
}

vec3 unpack_share(uint bits) {
    uvec3 steps = uvec3(bits, bits >> 9, bits >> 18) & 511u;
    return vec3(steps) * exp2(float(int(bits >> 27) - 24));
}

// What comes along the links of a texel, 1/N Σ_l w_l·E(y_l), W/m². Link i of all texels lies after link i − 1 of all. `map`: of the maps of light that lie one behind the other.
vec3 light_along_links(usamplerBuffer links, uint texel_count, uint link_count, uint number, samplerBuffer light, uint map) {
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint i = 0u; i < link_count; ++i) {
        uvec2 link = texelFetch(links, int(i * texel_count + number)).xy;
        if (link.x != NO_TEXEL) {
            sum += unpack_share(link.y) * texelFetch(light, int(map * texel_count + link.x)).rgb;
        }
    }
    return sum / float(link_count);
}

#endif
