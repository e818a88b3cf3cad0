// The light caches of a frame (src/frame/caches/): how many there are, where they lie, and where pixels find them.
// group: bindings 152 to 159
#ifndef GROUPS_LIGHT_CACHES
#define GROUPS_LIGHT_CACHES

#include "caches/cascades.glsl"
#include "caches/horizons.glsl"

layout(set = 0, binding = 152) uniform CascadeBlock { Cascades cascades; };
layout(set = 0, binding = 153) uniform usamplerBuffer cache_head;       // word 3: how many
layout(set = 0, binding = 154) uniform samplerBuffer cache_positions;   // render space, and the cascade's cell, m
layout(set = 0, binding = 155) uniform usamplerBuffer cache_addresses;  // caches/cascades.glsl

layout(set = 0, binding = 156) uniform usamplerBuffer cache_horizons;   // caches/horizons.glsl

vec3 position_of_cache(uint index) {
    return texelFetch(cache_positions, int(index)).xyz;
}

// Of the surfaces that ask for it and face one of six ways; false if none does.
bool horizon_of_cache(uint index, uint facing, out Horizon horizon) {
    int first = 2 * int(FACINGS * index + facing);
    uvec4 low = texelFetch(cache_horizons, first);
    if (is_nowhere(low)) {
        return false;
    }
    horizon = unpack_horizon(low, texelFetch(cache_horizons, first + 1), texelFetch(cache_positions, int(index)).w);
    return true;
}

#endif
